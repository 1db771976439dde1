// Every stage of the renderer by name, in the order in which data flows: what the wave runs, the profile counts and the
// plan chooses from.
#pragma once

#include <cstdint>

namespace lanewise {

//   X(enumerator, name of the kernel)
#define LANEWISE_STAGES(X)                  \
  X(kGenerate, generate)                    \
  X(kIntersect, intersect)                  \
  X(kSort, sort)                            \
  X(kEmission, emission)                    \
  X(kEnvironment, environment)              \
  X(kRetire, retire)                        \
  X(kSurface, surface)                      \
  X(kTexture, texture)                      \
  X(kSampleLight, sample_light)             \
  X(kSampleEnvironment, sample_environment) \
  X(kSampleHemisphere, sample_hemisphere)   \
  X(kConnectSphere, connect_sphere)         \
  X(kLightDiffuse, light_diffuse)           \
  X(kLightTextured, light_textured)         \
  X(kLightMicrofacet, light_microfacet)     \
  X(kLightRoughGlass, light_rough_glass)    \
  X(kOcclude, occlude)                      \
  X(kOccludeConnection, occlude_connection) \
  X(kGatherEmission, gather_emission)       \
  X(kShadeDiffuse, shade_diffuse)           \
  X(kShadeTextured, shade_textured)         \
  X(kShadeMicrofacet, shade_microfacet)     \
  X(kShadeRoughGlass, shade_rough_glass)    \
  X(kShadeMirror, shade_mirror)             \
  X(kShadeGlass, shade_glass)               \
  X(kRoulette, roulette)                    \
  X(kTakeLamps, take_lamps)                 \
  X(kKeepFirst, keep_first)                 \
  X(kKeepSecond, keep_second)               \
  X(kConnectPaths, connect_paths)           \
  X(kSharePaths, share_paths)               \
  X(kEmit, emit)                            \
  X(kAdjoint, adjoint)                      \
  X(kConnectCamera, connect_camera)         \
  X(kSplat, splat)                          \
  X(kAccumulate, accumulate)

enum class Stage : uint8_t {
#define LANEWISE_ENUMERATOR(enumerator, name) enumerator,
  LANEWISE_STAGES(LANEWISE_ENUMERATOR)
#undef LANEWISE_ENUMERATOR
      kCount
};
constexpr int kStageCount = static_cast<int>(Stage::kCount);

constexpr const char* kStageNames[] = {
#define LANEWISE_NAME(enumerator, name) #name,
    LANEWISE_STAGES(LANEWISE_NAME)
#undef LANEWISE_NAME
};

}  // namespace lanewise
