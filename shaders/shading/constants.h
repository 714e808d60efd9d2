// Constants and guards. A guard is an epsilon, clamp or saturate that keeps the arithmetic finite and is no part of a model. Every guard of the shading text is
// declared here, in one line with its number, below a comment that is its reason; nothing else invents one. `burnish stability` lists them with the energy that each costs.

#define BURNISH_PI R(3.14159265358979323846)

// Mean square error of the 24-bit octahedral normal, rad² (shading/normals.h; 2 million random unit vectors).
#define BURNISH_NORMAL_VARIANCE R(1.61e-7)

// Perceptual roughness where it enters the G-buffer; its square is the next guard.
#define BURNISH_ROUGHNESS_MIN R(0.02)

// Perceptual roughness is held at 0.02 (alpha 4e-4) where it enters the G-buffer: narrower lobes than the normal's 24 bits can carry.
#define BURNISH_ALPHA_MIN GUARDED(1, R(0.0004), R(1e-30))

// alpha is held at 1e-6 inside the terms, so that 1/alpha^2 and the power 2/alpha^2 - 2 stay finite for any number that comes in.
#define BURNISH_GUARD_ALPHA GUARDED(2, R(1e-6), R(0.0))

// |l + v|^2 under this means that the light is behind the surface's far side (l = -v): there is no half vector and n·l <= 0 makes the term zero anyway.
#define BURNISH_GUARD_HALF GUARDED(3, R(1e-7), R(0.0))

// Squared distance to a punctual light, m²: nearer than 1 cm the inverse square is held (a lamp has a size).
#define BURNISH_GUARD_DISTANCE2 GUARDED(4, R(1e-4), R(0.0))

// n·v under this is treated as grazing at this angle where a term divides by it (interpolated normals may face away from the eye).
#define BURNISH_GUARD_NOV GUARDED(5, R(1e-4), R(0.0))

// Arguments of logarithms are held above this; (n·h)^p is 0 there for every p that the pipeline uses.
#define BURNISH_GUARD_LOG GUARDED(6, R(1e-30), R(0.0))

// (n·h)^2 is held above this where it divides (Beckmann, Ward): the exponential is 0 there for every alpha up to 1.
#define BURNISH_GUARD_COS2 GUARDED(7, R(1e-6), R(0.0))

// Denominators of visibility terms are held above this: they vanish where light and eye both graze, and n·l, which multiplies the term, vanishes with them.
#define BURNISH_GUARD_VISIBILITY GUARDED(8, R(1e-12), R(0.0))

// 1 - sqrt(F0) is held above this: the index of refraction that gives F0 = 1 is infinite.
#define BURNISH_GUARD_INDEX GUARDED(9, R(1e-6), R(0.0))

// Denominators of Fresnel's equations, which vanish at grazing incidence when nothing is reflected or all is, and squares of indices of refraction that are not physical.
#define BURNISH_GUARD_FRESNEL GUARDED(10, R(1e-12), R(0.0))

// The energy that a lobe loses, 1 - mean albedo, is held above this where it divides: a lobe that loses nothing has nothing to give back, and the DFG table rounds to 1.5e-5.
#define BURNISH_GUARD_LOSS GUARDED(11, R(1e-4), R(0.0))

// Lengths under this are no direction: a zero normal becomes +z.
#define BURNISH_GUARD_LENGTH GUARDED(12, R(1e-30), R(0.0))

// Random numbers are held this far from 0, where the tails of Beckmann's lobe and of the cosine powers begin at infinity or at the horizon (2^-25: half a step of 24-bit numbers).
#define BURNISH_GUARD_RANDOM GUARDED(13, R(2.9802322e-8), R(0.0))

// Radiance is held at what half floats hold where a tone curve would overflow.
#define BURNISH_GUARD_RADIANCE GUARDED(14, R(65504.0), NO_LIMIT)

// Arguments of AgX's logarithm, which is undefined at 0 and below; 1e-10 lies below its black point of 2^-12.47.
#define BURNISH_GUARD_AGX GUARDED(15, R(1e-10), -NO_LIMIT)

// Cosines, codes and reflectances of unit range: dot products of unit vectors leave [0, 1] by rounding, maps by filtering, a host's numbers by anything.
FN real unitClamp(real x) { return GUARDED(16, clamp(x, R(0.0), R(1.0)), x); }

// Numbers that cannot be negative but for rounding (squared sines, what is left of energy).
FN real notNegative(real x) { return GUARDED(17, max(x, R(0.0)), x); }

// Numbers that no exponent or product can bear are held at 1e18, whose square is still a float.
FN real heldLarge(real x) { return GUARDED(18, clamp(x, R(-1e18), R(1e18)), x); }
