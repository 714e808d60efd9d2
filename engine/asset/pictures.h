// The pictures that materials use: found inside the asset's folder, decoded once each.
#pragma once
#include "asset/buffers.h"

namespace burnish::asset {

/// One Picture per image of the file; images that name one file share the first one's (textures are redirected). Only
/// those that a material refers to are read and decoded; a damaged or missing one stays empty, with a warning. Paths
/// that leave the asset's folder or name something other than a regular file are faults, of unused pictures too.
std::vector<Picture> loadPictures(Check& check, Document& doc, Source& source, ImageDecoder& decoder);

/// Takes texture references whose picture is missing or empty out of the materials.
void dropMissingTextures(Check& check, std::vector<Material>& materials, const std::vector<Texture>& textures,
                         const std::vector<Picture>& pictures);

}  // namespace burnish::asset
