// GLSL's functions by their names; included once for each precision.
using glm::abs;
using glm::acos;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp2;
using glm::floor;
using glm::inversesqrt;
using glm::log2;
using glm::max;
using glm::min;
using glm::normalize;
using glm::pow;
using glm::sin;
using glm::sqrt;
