// Constants and guards. Every guard (epsilon, clamp) of the shading text is declared here with its reason; nothing else invents one.

#define BURNISH_PI R(3.14159265358979323846)

// Perceptual roughness is clamped here before it enters the pipeline (alpha 4e-4): narrower lobes than the normal's 24 bits can carry.
#define BURNISH_ROUGHNESS_MIN R(0.02)
#define BURNISH_ALPHA_MIN R(0.0004)

// |l + v|^2 under this means that the light is behind the surface's far side (l = -v): there is no half vector and n·l <= 0 makes the term zero anyway.
#define BURNISH_GUARD_HALF R(1e-7)

// Squared distance to a punctual light, m²: nearer than 1 cm the inverse square is held (a lamp has a size).
#define BURNISH_GUARD_DISTANCE2 R(1e-4)

// n·v under this is treated as grazing at this angle (interpolated normals may face away from the eye).
#define BURNISH_GUARD_NOV R(1e-4)

// Arguments of logarithms are held above this; (n·h)^p is 0 there for every p that the pipeline uses.
#define BURNISH_GUARD_LOG R(1e-30)
