// glTF materials to Burnish's: two or three merged maps each, shared between materials that ask for the same merge.
// It stands in scene/, above material/, because what it makes are rows of a Scene.
#pragma once
#include <functional>
#include <optional>

#include "material/merge.h"
#include "scene/picture_store.h"

namespace burnish::scene {

/// How far the codec's nearest grey dielectric is from an F0.
float dielectricError(const glm::vec3& f0);
/// Why the codec has no dielectric of this F0, in words; nullptr when it has one.
const char* whyNoDielectric(const glm::vec3& f0);

class MaterialConverter {
 public:
  /// The asset must outlive the converter. Textures and materials are added to `scene`; what does not fit goes to
  /// `report` with its error.
  MaterialConverter(const asset::Asset& asset, Scene& scene, Report& report)
      : asset_(asset), scene_(scene), report_(report), pictures_(asset) {}

  struct Converted {
    Id<Material> id;
    /// What tangents follow: the normal map's mapping, or uv set 0 for anisotropy without one; empty: meshes need none.
    std::optional<UvMapping> tangents;
    bool normalMap = false;  ///< a normal map is what needs them
  };
  /// Converts a material (-1: glTF's default) and adds it. `vertexAlpha`: some mesh with this material has vertex
  /// colours with alpha below 1.
  Converted convert(int index, bool vertexAlpha);

 private:
  using ConversionError = material::ConversionError;
  struct Shared {
    Id<Texture> texture;
    ConversionError error;
  };

  // convert_material.cpp
  void metalRough(const asset::Material& in, Material& out);
  void keepApart(const asset::Material& in, Material& out, const Slot& base, const Slot& normal,
                 const Slot& metalRough);
  void mapA(const asset::Material& in, Material& out, const Slot& base, const Slot& metalRough,
            std::optional<float> metalness);
  void substance(Material& out, float metalness, const glm::vec3& f0);
  void mapB(Material& out, const Slot& normal, float normalScale, const Slot& rough, int channel, bool gloss,
            float factor);
  void mapC(const asset::Material& in, Material& out, const Slot& base, bool vertexAlpha);
  void emission(const asset::Material& in, Material& out);
  void anisotropy(const asset::Material& in, Material& out);
  void glass(const asset::Material& in, Material& out);
  float meanOf(const asset::TextureRef& texture, int channel, const char* what);
  Slot normalSlot(const asset::Material& in, const Material& out) const;

  // convert_specular.cpp
  void specularGlossiness(const asset::Material& in, Material& out);
  struct Dielectric {
    glm::vec3 f0{material::kPlasticF0};  ///< KHR_materials_ior and the factors of KHR_materials_specular
    Slot strength, color;                ///< KHR_materials_specular's textures
  };
  Dielectric dielectricOf(const asset::Material& in);
  Slot compatibleOrMean(const Slot& slot, const Slot& partner, const char* what, glm::vec4& factor, bool srgb);

  /// The texture made earlier under this key, or a new one from `make`.
  const Shared& shared(std::string key, std::string name, MapKind kind, const Sampler& sampler,
                       const std::function<Image(ConversionError&)>& make);
  float checked(float value, float low, float high, float fallback, const char* what);
  glm::vec3 checked(const glm::vec3& value, float high, const char* what);
  void warn(std::string what) { report_.warn(place_, std::move(what)); }
  void reportError(const ConversionError& error, const char* why);

  const asset::Asset& asset_;
  Scene& scene_;
  Report& report_;
  PictureStore pictures_;
  std::string place_;                     ///< of the material in work, for the report
  std::map<std::string, Shared> shared_;  ///< merges made so far, by what they were made of
};

}  // namespace burnish::scene
