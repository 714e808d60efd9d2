// A disc of light as an analytic light shows it: engine/stability/disc.h.
#pragma once
#include "oracle.h"
#include "stability/disc.h"

namespace burnish::test {

using stability::Disc;
using stability::discCube;
using stability::DiscProfile;

}  // namespace burnish::test
