// One picture through one worker: the program's side of DecodeRequest and DecodeAnswer
// (engine/image/decode_protocol.h).
#pragma once
#include "image/decode_keeper.h"
#include "image/picture_header.h"

namespace burnish::image {

enum class Outcome {
  Answered,  ///< `picture` is the worker's answer; it is ready for the next
  Unsent,    ///< the worker was gone before it got the request
  Died,      ///< it went away while at it
  TimedOut,  ///< it did not finish in time
  Unusable,  ///< `picture` holds an error; the worker is in no state to go on (its answers make no sense, or no memory
             ///< here)
};
struct Conversation {
  Outcome outcome;
  Result<Image> picture;
};

/// Decodes `file`, whose header was read and found within the limits. Whatever the outcome but Answered, end the
/// worker. The answers are believed no more than the file is: sizes are checked against `header` and `limits`.
Conversation decodeWith(Worker& worker, std::span<const std::byte> file, std::string_view name,
                        const PictureHeader& header, const DecodeLimits& limits);

}  // namespace burnish::image
