// Surroundings as one picture: which layout a picture's shape stands for, and the cube in it.
// Faces lie as OpenGL stores them (OpenGL 4.5 specification, table 8.19): what one sees from inside, with +Z ahead, +X to the right of it and +Y up.
//   horizontal cross 4:3        vertical cross 3:4       strips 6:1, 1:6
//        [+Y]                        [+Y]                [+X][-X][+Y][-Y][+Z][-Z]
//   [-X] [+Z] [+X] [-Z]         [-X] [+Z] [+X]           from left to right, or from top to bottom
//        [-Y]                        [-Y]
//                                    [-Z], turned by 180 degrees
#pragma once
#include <burnish/image.h>

#include <optional>
#include <string_view>

namespace burnish::image {

enum class PictureLayout : std::uint8_t { LatLong, HorizontalCross, VerticalCross, HorizontalStrip, VerticalStrip };

/// By shape alone; none for any other shape.
std::optional<PictureLayout> pictureLayout(int width, int height);
std::string_view layoutName(PictureLayout layout);

/// F32, three channels, linear: 8- and 16-bit pictures are sRGB; grey becomes RGB, alpha is left out.
Image linearRgb(Image picture);

/// The cube of a picture of linearRgb that is no lat-long one.
CubeLevel cubeFromPicture(const Image& rgb, PictureLayout layout);
/// Whether the parts of a cross that belong to no face hold more than one colour: then it is likely no cross.
bool crossHasContent(const Image& rgb, PictureLayout layout);

/// Copies the size² square at (x, y) of a picture to a face.
void copyFace(const Image& rgb, int x, int y, bool turned, CubeLevel& level, std::size_t face);

/// All levels of a cubemap in one picture: strips (+X -X +Y -Y +Z -Z from left to right), the largest on top, each at the left edge; black elsewhere. F32, three channels.
Image stackedStrips(const Cubemap& cubemap);
/// The other way round; levels are as many as halving strips make the picture's height. None: the picture is no such stack.
std::optional<Cubemap> cubeFromStackedStrips(const Image& rgb);

}  // namespace burnish::image
