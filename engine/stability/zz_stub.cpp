#include "stability/cases.h"
namespace burnish::stability {
std::vector<PictureCase> filterPictureCases() { return {}; }
std::vector<PictureCase> screenPictureCases() { return {}; }
std::vector<PictureCase> surfacePictureCases() { return {}; }
std::vector<OracleCase> filterOracleCases() { return {}; }
}
