// Table of contents: every kernel, in the order in which data flows through them.
//
// A kernel is a pure function of the plan and of its lanes: no lane depends on another (but in sort, connect_paths and
// share_paths), nothing is allocated, read from a file or kept. It may touch slots [range.begin, range.end rounded up to kLanes) and reads and writes only the fields listed
// below it (padding lanes hold the harmless dummy path). Each runs the best instruction set that the machine has and hwy allows;
// its scalar twin of the same name is kernels/reference/<file>.h, a template over float (what the kernel reproduces)
// and double (the oracle). "p" below is the hit point in o_x, o_y, o_z once `surface` has run. Radiance in W / (m^2
// sr), lengths in scene units, densities per steradian.
#pragma once

#include <cstdint>

#include "core/path_state.h"
#include "core/pixel_sums.h"
#include "core/plan.h"
#include "core/types.h"
#include "kernels/bounds.h"
#include "kernels/fields.h"

namespace lanewise {

using Kernel = void(const Plan&, const PathState&, Range);

// Starts camera paths: uniform in the pixel (a box filter of one pixel), from the eye or, with a thin lens, uniform on the
// lens and through the point where the ray from the eye meets the plane in focus.
void generate(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kGenerateFields = {.reads = "batch", .writes = "pixel sample slot o d beta L pdf lamps"};
constexpr KernelBounds kGenerateBounds = {.fields = {exact("pixel"), exact("sample"), reach_ulps("o", 0.25),
                                                     exact("beta"), exact("L"), exact("pdf"), exact("lamps"),
                                                     ulps("d", 2.5)}};

// Closest hit. Triangles are watertight (edge tests with exact signs after Woop, Benthin & Wald, JCGT 2013), spheres by the
// stable quadratic of Haines et al., Ray Tracing Gems ch. 7. Of hits at the same t the lowest prim wins. A path with beta = 0
// is not traced and goes to kFinished, as does one that misses (but to kSky where there is an environment), or that may not
// scatter at what it meets because it has done so max_depth times.
void intersect(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kIntersectFields = {.reads = "o d beta step", .writes = "prim t u v bin"};
// The choice is that of the primitive. Of those that share the edge or vertex that is hit, rounding decides which it is; the
// distance is the same. A few rays in a hundred are aimed at edges. The largest errors are those of faces that a ray grazes.
constexpr KernelBounds kIntersectBounds = {
    .fields = {exact("prim"), exact("bin"), input_ulps("t", 3), input_ulps("u", 0.75), input_ulps("v", 0.75)},
    .choice = {.margin = 4, .max_share = 0.008, .decisive = "t"}};

// Where each bin lies after the sort; bins begin at multiples of kLanes.
struct Bins {
  Range bin[kBinCount];
  uint32_t dead = 0;  // of kFinished: paths that came with beta = 0, which intersect does not trace

  Range operator[](uint32_t b) const { return bin[b]; }
  // From the first slot of bin `first` to the last of bin `last` - 1, with the padding between.
  Range span(uint32_t first, uint32_t last) const { return {bin[first].begin, bin[last - 1].end}; }
  uint32_t paths(uint32_t first, uint32_t last) const {
    uint32_t n = 0;
    for (uint32_t b = first; b < last; ++b) n += bin[b].size();
    return n;
  }
};

// Moves every path to its bin, and drops the padding that the sort before left: stable, bins contiguous, each padded with
// the dummy path to a multiple of kLanes. Of what goes to kFinished only slot and L are
// moved: nothing else of it will be read. Nor is an array moved that both states share (u and v, where no normal needs them): it
// holds anything then.
// Writes also all fields of the padding.
Bins sort_by_bin(const PathState& from, const PathState& to, Range range);
constexpr KernelFields kSortFields = {.reads = "bin KEPT", .writes = "KEPT"};

// Where there are light paths: who brings what lamps send next, as the paths are at a diffuse surface (step.diffuse) or another.
void take_lamps(const Plan& plan, const PathState& s, Range range);
// A direction d that does not agree with the normals of a surface leaves all to the path itself; where it leaves the surface
// (step.leaving), that is all.
constexpr KernelFields kTakeLampsFields = {.reads = "d n s lamps step", .writes = "lamps"};
constexpr KernelBounds kTakeLampsBounds = {.fields = {exact("lamps")}, .choice = {.margin = 4, .max_share = 2e-4}};

// Where paths are used again (core/path_reuse.h): of paths at diffuse surfaces, keeps the vertex if it is the first of that kind,
// once they have left it, and the surface is shaded by its own normal, and not black: from a black one no path goes on.
void keep_first(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kKeepFirstFields = {.reads = "slot o d n s beta kept step", .writes = "kept"};

// Of paths whose bounce before was at such a vertex the second one, if that is like it, and L. The path goes on with L = 0 and beta = its largest
// channel, which roulette then goes by: where several surfaces are coloured it ends fewer paths, without bias as ever.
void keep_second(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kKeepSecondFields = {.reads = "slot o d n s err beta L kept step", .writes = "kept L beta"};
// All but y and gain to the bit.
constexpr FieldBound kKeepSecondBound = ulps("kept", 2);

// By slot: aims from the first vertex of slot i ^ step.partner at the second one of slot i; channel partner - 1 of c is the
// density of y_i there, times pi. The first partner sets L to 0.
void connect_paths(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kConnectPathsFields = {.reads = "kept step", .writes = "o n err l c L"};
// Of l; and of the density where both surfaces face each other: at grazing angles its cosines are differences of larger numbers.
constexpr FieldBound kConnectPathsBound = ulps("l", 8);

// By slot: shares out what each path has found behind its second vertex to the result of its own pixel and of its partners that see
// it, which L says.
void share_paths(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kSharePathsFields = {.reads = "kept L result", .writes = "result kept l_pdf L c"};
// Of all that is in the square. At grazing angles a weight may be another, but nothing is lost: the sum is within it.
constexpr FieldBound kSharePathsBound = ulps("result", 16);

// Starts the light paths batch.first_path and following of lamp step.light: from a point of it, uniform by area, in a direction
// uniform over the cones in which the plan's casters are seen from there; what lies in several counts by their number.
void emit(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kEmitFields = {.reads = "batch step", .writes = "pixel sample slot o d beta L pdf lamps"};
// The cosine at the lamp, which beta hangs on, is the difference of larger numbers at grazing angles. The choice is that of a cone,
// and whether the direction lies in others.
constexpr KernelBounds kEmitBounds = {
    .fields = {exact("pixel"), exact("sample"), reach_ulps("o", 2), input_ulps("beta", 8, 2e-6), exact("L"),
               exact("pdf"), exact("lamps"), ulps("d", 16)},
    .choice = {.margin = 4, .max_share = 2e-3}};

// Where shading normals s are not the surface's own n, what a light path carries is, over what a path from the camera would have by
// the same surfaces, |d_in.n| |d_out.s| / (|d_in.s| |d_out.n|) too much (Veach 1997, eq. 5.19): multiplies beta by |d.s| / |d.n|,
// or by the inverse when d leaves the vertex (step.leaving); by 0 where d does not agree with the normals.
void adjoint(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kAdjointFields = {.reads = "d n s beta step", .writes = "beta"};
constexpr KernelBounds kAdjointBounds = {.fields = {input_ulps("beta", 4)}, .choice = {.margin = 4, .max_share = 2e-4}};

// Aims from light paths at diffuse surfaces at the camera, a point of its lens: c is the radiance that the pixel `raster` gets if
// nothing is in the way, beta f |n.l| / (|l|^2 cos^3) over a pixel's area at distance 1, cos the angle with the view's axis; 0
// outside of the window. L becomes 0.
void connect_camera(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kConnectCameraFields = {.reads = "pixel sample prim o d n s err beta a step",
                                               .writes = "l c L raster"};
constexpr KernelBounds kConnectCameraBounds = {
    .fields = {reach_ulps("l", 2.5), input_ulps("c", 8), exact("L"), exact("raster")},
    .choice = {.margin = 4, .max_share = 2e-3}};

// splat is no kernel but add_splats() of core/splats.h: it sets aside what the camera sees, L at `raster`.
constexpr KernelFields kSplatFields = {.reads = "L raster", .writes = ""};

// Adds the radiance of the light that was hit from its front, weighted against light sampling by the power heuristic
// (Veach 1997, eq. 9.13 with exponent 2). None where a connection has counted it, see kConnected, or light paths bring it.
void emission(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kEmissionFields = {.reads = "prim t o d beta pdf lamps L", .writes = "L"};
// Hangs on the cosine at grazing angles; front or back is a choice.
constexpr KernelBounds kEmissionBounds = {.fields = {input_ulps("L", 3)}, .choice = {.margin = 4, .max_share = 2e-4}};

// Adds the radiance of the environment that a path which has missed the scene comes to, weighted in the same way against
// samples of the environment. Connections do not count it.
void environment(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kEnvironmentFields = {.reads = "d beta pdf L", .writes = "L"};
// The density is another in the next cell of the map. In maps of many columns that differ much, the rounding of the azimuth in
// turns shows above that of d, and more directions lie on edges of cells.
constexpr KernelBounds kEnvironmentBounds = {.fields = {input_ulps("L", 5)},
                                             .choice = {.margin = 4, .max_share = 2e-3}};

// Hands the radiance of finished paths over to the wave's result, by slot.
void retire(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kRetireFields = {.reads = "slot L", .writes = "result"};

// From a hit to a shading point: the hit point, put back onto the surface along its normal, its normals and the
// distance that a ray origin must keep (Waechter & Binder, Ray Tracing Gems ch. 6; pbrt 4 sec. 6.8 for the bounds).
void surface(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kSurfaceFields = {.reads = "prim t u v o d", .writes = "o n s err"};
// The normals of small spheres magnify the rounding of the hit point.
constexpr KernelBounds kSurfaceBounds = {
    .fields = {reach_ulps("o", 2), input_ulps("n", 0.5), input_ulps("s", 2), exact("err")}};

// In scenes with textures, of diffuse surfaces: a = reflectance times the texture at the hit point, bilinear between the texels
// around it, repeated beyond its edges.
void texture(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kTextureFields = {.reads = "prim o", .writes = "a"};
// Moving the point moves the place in the texture; across a texel's border the colour's slope changes, not the colour. A
// millionth is a thousandth of the step between two of 8 bits' values.
constexpr KernelBounds kTextureBounds = {.fields = {input_ulps("a", 4, 1e-6)}};

// Samples light step.light by area and aims at it; l_pdf is 0 where the surface is behind the light.
void sample_light(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kSampleLightFields = {.reads = "pixel sample o n err step", .writes = "l l_pdf"};
// The density has no bound in the light's own plane; its inverse, which is what c is made with, goes to 0 there. The choice is
// the side that the origin is moved to.
constexpr KernelBounds kSampleLightBounds = {.fields = {reach_ulps("l", 2.5), inverse_input_ulps("l_pdf", 3)},
                                             .choice = {.margin = 4, .max_share = 2e-4}};

// Samples the environment, light step.light after the scene's own, and aims at it; c is the radiance that comes from there if
// nothing is in the way. l goes out of the scene: EnvironmentMap::reach.
void sample_environment(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kSampleEnvironmentFields = {.reads = "pixel sample step", .writes = "l l_pdf c"};
// The azimuth in turns is rounded on the way to l. Where between two rows of texels a direction lies comes out of its angle to
// the pole, in rows, to some millionths of one: where radiance is 50 in one and 0 in the next, c is as far off.
constexpr KernelBounds kSampleEnvironmentBounds = {
    .fields = {ulps("l", 9), exact("l_pdf"), {"c", Unit::kUlp, 4, 4e-4}}};

// -H: aims uniformly into the hemisphere around the viewer's side of the shading normal; l is a unit vector.
void sample_hemisphere(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kSampleHemisphereFields = {.reads = "pixel sample d s step", .writes = "l l_pdf"};
constexpr KernelBounds kSampleHemisphereBounds = {.fields = {ulps("l", 3), exact("l_pdf")}};

// Samples light step.light by area, by way of one of the plan's connected spheres, and aims at where that reflects it
// (kernels/reflection-inl.h); m goes on from there. l_pdf is the density of l, over the reflectance by Fresnel of glass; 0
// where nothing is reflected, or light paths bring what is.
void connect_sphere(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kConnectSphereFields = {.reads = "pixel sample o n s err lamps step", .writes = "l m l_pdf via"};
// The density has no bound where light grazes; and near the sphere's horizon it goes with small heights over a tangent plane,
// which come from larger numbers: so above 4 ulp.
constexpr KernelBounds kConnectSphereBounds = {
    .fields = {reach_ulps("l", 2.5), reach_ulps("m", 2.5), inverse_input_ulps("l_pdf", 20), exact("via")},
    .choice = {.margin = 4, .max_share = 2e-4}};

// light_<material>: what the light sample adds if it is seen: c = beta f |cos| radiance / (l_pdf samples), times the MIS
// weight against the material's own density. The radiance is the light's, or the environment's from c; with -H it is not known
// yet and left out. Of connections
// the material's density is not weighed against, but says which are left to BSDF sampling (c = 0): see kMostConnectedPdf.
// 0 also where light paths bring what the light sends by way of the surface: see core/plan_light_paths.h.
// shade_<material>: samples the next direction, multiplies beta by f |cos| / pdf and moves the origin off the surface.
void light_diffuse(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kLightDiffuseFields = {.reads = "prim d s beta l l_pdf c step", .writes = "c"};
// Hangs on the cosine at grazing angles.
constexpr KernelBounds kLightDiffuseBounds = {.fields = {input_ulps("c", 4)},
                                              .choice = {.margin = 4, .max_share = 2e-4}};
void shade_diffuse(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kShadeDiffuseFields = {.reads = "pixel sample prim o d n s err beta step",
                                              .writes = "o d beta pdf"};
// The choices, here and for the other materials: the side that the path arrives from, and the side that the origin is moved to.
constexpr KernelBounds kShadeDiffuseBounds = {.fields = {exact("beta"), ulps("o", 0.9), ulps("d", 2.5), ulps("pdf", 3)},
                                              .choice = {.margin = 4, .max_share = 2e-4}};
// The same in scenes with textures, where `texture` has found the albedo.
void light_textured(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kLightTexturedFields = {.reads = "d s beta l l_pdf c a step", .writes = "c"};
constexpr KernelBounds kLightTexturedBounds = kLightDiffuseBounds;
void shade_textured(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kShadeTexturedFields = {.reads = "pixel sample o d n s err beta a step",
                                               .writes = "o d beta pdf"};
constexpr KernelBounds kShadeTexturedBounds = kShadeDiffuseBounds;
// Torrance-Sparrow with Beckmann's D, Smith's separable G and conductor Fresnel per channel (Walter et al. 2007).
void light_microfacet(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kLightMicrofacetFields = {.reads = "prim d n s beta lamps l l_pdf c step", .writes = "c"};
// Beckmann's exponent, tan^2 / alpha^2, hangs on the last bits of every direction when alpha is small, and those of the half
// vector, rounded on the way, add to what moving the directions shows: so above 4 ulp. Where e^x is below float's range it
// counts as 0.
constexpr KernelBounds kLightMicrofacetBounds = {.fields = {input_ulps("c", 7, 1e-24)},
                                                 .choice = {.margin = 4, .max_share = 2e-4}};
void shade_microfacet(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kShadeMicrofacetFields = {.reads = "pixel sample prim o d n s err beta step",
                                                 .writes = "o d beta pdf"};
// Above 4 ulp: a visible slope is where its distribution, which a float knows to 1e-6, takes a value, and in the tails small
// errors of it move the slope. That the pdf is the density of the direction that was really sampled does not hang on this.
constexpr KernelBounds kShadeMicrofacetBounds = {
    .fields = {input_ulps("beta", 160, 1e-24), ulps("o", 0.9), input_ulps("d", 64), input_ulps("pdf", 13)},
    .choice = {.margin = 4, .max_share = 2e-4}};
// Rough dielectric: Beckmann's D, Smith's separable G, microfacets that reflect or refract by the dielectric Fresnel
// reflectance, chosen among the visible ones (Walter et al. 2007; Heitz & d'Eon 2014). Takes light from both sides. Under -H, which
// looks for lights on the viewer's side, pdf = 0 behind refraction.
void light_rough_glass(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kLightRoughGlassFields = {.reads = "prim d n s beta lamps l l_pdf c step", .writes = "c"};
// As for the metals, and near the critical angle and near an index of 1 the half vector is a small difference of two long ones.
constexpr KernelBounds kLightRoughGlassBounds = {.fields = {input_ulps("c", 20, 1e-24)},
                                                 .choice = {.margin = 4, .max_share = 2e-4}};
void shade_rough_glass(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kShadeRoughGlassFields = {.reads = "pixel sample prim o d n s err beta step",
                                                 .writes = "o d beta pdf"};
// The visible slope as for the metals. A choice is also that of the lobe.
constexpr KernelBounds kShadeRoughGlassBounds = {
    .fields = {input_ulps("beta", 160, 1e-24), ulps("o", 0.9), input_ulps("d", 64), input_ulps("pdf", 64)},
    .choice = {.margin = 4, .max_share = 2e-4}};
// Perfect reflection; pdf = 0 (delta), or kConnected.
void shade_mirror(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kShadeMirrorFields = {.reads = "prim o d n s err beta pdf", .writes = "o d beta pdf"};
constexpr KernelBounds kShadeMirrorBounds = {.fields = {exact("beta"), ulps("o", 0.9), ulps("d", 3), exact("pdf")},
                                             .choice = {.margin = 4, .max_share = 2e-4}};
// Smooth dielectric: reflects or refracts by the Fresnel reflectance; refracted radiance scales with the squared ratio
// of indices (Veach 1997, ch. 5), the power of light paths does not; pdf = 0 (delta), or kConnected.
void shade_glass(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kShadeGlassFields = {.reads = "pixel sample prim o d n s err beta pdf step",
                                            .writes = "o d beta pdf"};
// The refracted direction hangs on a root near the critical angle. A choice is also that of the lobe.
constexpr KernelBounds kShadeGlassBounds = {
    .fields = {ulps("beta", 3), ulps("o", 0.9), input_ulps("d", 1), exact("pdf")},
    .choice = {.margin = 4, .max_share = 2e-4}};

// Any hit on the open segment from the offset hit point to the light sample: if there is none, L += c. Not traced where
// c = 0. Faces that cannot block light between points of the scene, nor from an environment, are left out: the plan knows which.
void occlude(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kOccludeFields = {.reads = "o n err l c L", .writes = "L"};
// The choice: blocked or not.
constexpr KernelBounds kOccludeBounds = {.fields = {ulps("L", 1)}, .choice = {.margin = 4, .max_share = 2e-4}};

// The same for a connection, on l and from where it ends on m: L += c times the reflectance of via.
void occlude_connection(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kOccludeConnectionFields = {.reads = "o n err l m via c L", .writes = "L"};
constexpr KernelBounds kOccludeConnectionBounds = {.fields = {ulps("L", 2)},
                                                   .choice = {.margin = 4, .max_share = 2e-4}};

// -H: the closest hit along l, and L += c times its radiance if it is the front of an emitter, or the environment's if there is
// none. Not traced where c = 0.
void gather_emission(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kGatherEmissionFields = {.reads = "o n err l c L", .writes = "L"};
// Hangs on the direction where the environment's radiance does.
constexpr KernelBounds kGatherEmissionBounds = {.fields = {input_ulps("L", 3)},
                                                .choice = {.margin = 4, .max_share = 2e-4}};

// Russian roulette from bounce kRouletteBounce on: survives with probability q = min(1, max channel of beta) and beta / q,
// else beta = 0; unbiased for every q. So it never lifts a throughput above 1, and what ends a path of throughput 1 is
// max_depth alone: a survival bounded below 1 would raise such paths by 1 / q at every bounce, and the variance without end.
void roulette(const Plan& plan, const PathState& s, Range range);
constexpr KernelFields kRouletteFields = {.reads = "pixel sample beta step", .writes = "beta"};
constexpr KernelBounds kRouletteBounds = {.fields = {ulps("beta", 2.5)}};
constexpr uint32_t kRouletteBounce = 4;

// Adds the batch's samples to their pixels' sums in the film (Batch::slots says where): the same sums as by PixelSums::add, which hang on no order. A sample with a
// NaN, infinite or negative channel counts as black. Returns the number of such invalid samples.
uint32_t accumulate(const PathState& s, PixelSums* film);
constexpr KernelFields kAccumulateFields = {.reads = "batch result", .writes = ""};

// How many paths of the range have a light sample worth a shadow ray: c != 0.
uint32_t count_shadow_rays(const PathState& s, Range range);

}  // namespace lanewise
