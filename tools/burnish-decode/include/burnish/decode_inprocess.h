// Decoding with OpenImageIO inside the program, for hosts that trust their pictures: a damaged file can crash it.
// Link Burnish::decode_inprocess (and with it OpenImageIO and its some 260 libraries); everybody else uses
// makeDecoderPool.
#pragma once
#include <burnish/image.h>

namespace burnish {

/// Accepts, checks and gives the same as the pool, without a process, a memory limit or a time limit
/// (DecodeLimits::seconds is not used). Safe to call from several threads at a time.
std::unique_ptr<ImageDecoder> makeInProcessDecoder();

}  // namespace burnish
