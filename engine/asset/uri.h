// URIs as glTF files hold them: what kind they are, and the bytes of data URIs (RFC 2397).
#pragma once
#include <burnish/result.h>

#include <cstddef>

namespace burnish::asset {

enum class UriKind { Relative, Data, Remote, Invalid };  ///< Remote: any other scheme, "file:" included
/// By the text alone. Invalid: empty, or a ':' in the first segment that no scheme stands before (RFC 3986,
/// section 4.2).
UriKind uriKind(std::string_view uri);

std::string percentDecoded(std::string_view text);

struct DataUri {
  std::string mediaType;  ///< lower case, without parameters; may be empty
  std::vector<std::byte> bytes;
};
/// Decodes a data URI. The error's `what` says what is malformed; `place` is left empty.
Result<DataUri> decodeDataUri(std::string_view uri);

}  // namespace burnish::asset
