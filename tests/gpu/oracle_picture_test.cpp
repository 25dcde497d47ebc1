// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare the project's scenes and a scene of everything with the oracle's pictures, pixel by pixel: ids,
// depth, normals and colour. Pixels that differ are printed with their margins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "gpu/device_fixture.h"
#include "gpu/faulty_shaders.h"
#include "gpu/gallery.h"
#include "gpu/test_scenes.h"
#include "oracle/compare_picture.h"
#include "oracle/sky.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"
#include "scene/glass.h"
#include "support/thorough.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

uint64_t count_primitives(const world::Scene& scene) {
  uint64_t count = 0;
  for (const world::Object& object : scene.objects) count += primitive_count(object.shape);
  return count;
}

/// Returns the size of pictures whose bounds do not depend on the size of pixels. It has a quarter of the pixels of
/// thorough tests, because brute force takes long. The smaller pictures show the same shapes, materials and lights.
uvec2 make_size() {
  return test::is_thorough() ? uvec2(96, 72) : uvec2(48, 36);
}

/// Returns the size of a scene's picture. Brute force takes time in proportion to primitives times rays, so larger
/// scenes get smaller pictures.
uvec2 size_for(const world::Scene& scene) {
  const uint64_t count = count_primitives(scene);
  if (count <= 2000) return make_size();
  return count <= 10000 ? uvec2(48, 36) : uvec2(20, 15);
}

/// Returns the view that `promin render` has of a scene, and adds the default lights if the scene needs them.
View camera_view_of(world::Scene& scene) {
  View view;
  view.size = size_for(scene);
  view.camera = scene.cameras.empty() ? look_from_front(scene, 4.0F / 3.0F) : scene.cameras.front();
  if (scene.lights.empty()) {
    scene.lights.push_back(make_headlight());
    scene.environment.ambient = vec3(0.1F);
  }
  return view;
}

void move(Mesh& mesh, const vec3& offset) {
  for (vec3& position : mesh.positions) position += offset;
}
void move(world::Plane& plane, const vec3& offset) {
  plane.point += offset;
}
void move(world::NotDrawn& /*shape*/, const vec3& /*offset*/) {}
template <class Solid>
void move(Solid& solid, const vec3& offset) {
  solid.center += offset;
}

class OraclePictureTest : public test::DeviceTest, public testing::WithParamInterface<std::string> {
 protected:
  static oracle::PictureReport compare(const world::Scene& scene, const View& view,
                                       const oracle::PictureBounds& bounds = {}) {
    return compare_with(oracle::render(scene, view), scene, view, bounds);
  }
  /// Uses kernels with the features of several scenes that are made from the scene of everything.
  static bool agrees_with_oracle(const world::Scene& scene, const View& view) {
    using namespace layout;
    const FeatureMask more = features_of(test::make_scene_of_everything()) | FEATURE_OPEN_SHAPES | FEATURE_FRESNEL |
                             FEATURE_COATS | FEATURE_SHEENS;
    return compare_with(oracle::render(scene, view), scene, view, {}, picture_shaders(), more).passes();
  }

  static oracle::PictureReport compare_with(const oracle::Picture& truth, const world::Scene& scene, const View& view,
                                            const oracle::PictureBounds& bounds,
                                            const PictureShaders& shaders = picture_shaders(),
                                            FeatureMask more_features = {}) {
    TunedRendererOptions options;
    options.with_aovs = true;
    options.shaders = shaders;
    options.more_features = more_features;
    const RenderResult result = make_renderer(device(), scene, options).render(view);
    const oracle::DeviceAovs aovs{result.aovs.depth, result.aovs.normal, result.aovs.object, result.aovs.primitive};
    oracle::PictureReport report = compare_picture(scene, truth, result.image, aovs, bounds);
    std::printf("%s\n", report.summary(scene).c_str());
    return report;
  }
};

/// Returns all scenes of the project. Those with the most features come first.
std::vector<std::string> scene_names() {
  std::vector<std::string> names = {"all_primitives.gltf",     "glass.gltf",        "light_physical.gltf",
                                    "metallic_roughness.gltf", "mirrors.gltf",      "showcase.gltf",
                                    "obj_materials.obj",       "vertex_colors.gltf"};
  const auto first = static_cast<std::ptrdiff_t>(names.size());
  for (const auto& entry : fs::directory_iterator(PROMIN_SCENES_DIR)) {
    const std::string name = entry.path().filename();
    const bool is_scene = name.ends_with(".gltf") || name.ends_with(".obj");
    if (is_scene && std::ranges::count(names, name) == 0) names.push_back(name);
  }
  std::sort(names.begin() + first, names.end());
  return test::cases_of(names, first);
}

TEST_P(OraclePictureTest, AgreesWithTheOracle) {
  world::Scene scene = world::flatten(load_scene(fs::path(PROMIN_SCENES_DIR) / GetParam()));
  View view = camera_view_of(scene);
  oracle::PictureBounds bounds;
  if (std::ranges::any_of(scene.materials, [](const Material& m) { return is_clear(m); })) {
    view.max_depth = kMaxDepthOfGlass;
    // Near the angle of total reflection, the oracle is not certain.
    bounds.unsure_share = 0.1;
  }
  EXPECT_TRUE(compare(scene, view, bounds).passes());
}

INSTANTIATE_TEST_SUITE_P(Scenes, OraclePictureTest, testing::ValuesIn(scene_names()), [](const auto& param_info) {
  std::string name = param_info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

TEST_F(OraclePictureTest, EverythingAgreesWithTheOracle) {
  EXPECT_TRUE(agrees_with_oracle(test::make_scene_of_everything(), test::make_view(make_size())));
}

TEST_F(OraclePictureTest, OpenShapesAgreeWithTheOracle) {
  world::Scene scene = test::make_scene_of_everything(60);
  for (world::Object& object : scene.objects) {
    std::visit(
        [](auto& shape) {
          if constexpr (requires { shape.is_open; }) shape.is_open = true;
        },
        object.shape);
  }
  // The view looks into the frustum through its wide open end.
  View view = test::make_view(make_size());
  view.camera.eye = vec3(-1.6F, 3.2F, 2.6F);
  view.camera.look = glm::normalize(vec3(0.25F, -1.0F, -0.2F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 0, -1)), view.camera.look));
  EXPECT_TRUE(agrees_with_oracle(scene, test::make_view(make_size())));
  EXPECT_TRUE(agrees_with_oracle(scene, view));
}

TEST_F(OraclePictureTest, AlphaAgreesWithTheOracle) {
  EXPECT_TRUE(compare(test::make_scene_of_alpha(), test::make_view(make_size())).passes());
}

TEST_F(OraclePictureTest, GlassAgreesWithTheOracle) {
  View view = test::make_view(make_size());
  view.max_depth = kMaxDepthOfGlass;
  // Near the angle of total reflection, the oracle is not certain.
  EXPECT_TRUE(
      compare(test::make_scene_of_glass(), view, {.color_mean = 1e-6L, .plain_mean = 1e-5L, .unsure_share = 0.1})
          .passes());
}

// A fault in any of these formulas makes a picture wrong, so GlassAgreesWithTheOracle can fail.
TEST_F(OraclePictureTest, EachFaultOfGlassDisagreesWithTheOracle) {
  const world::Scene scene = test::make_scene_of_glass();
  View view = test::make_view(uvec2(48, 36));
  view.max_depth = kMaxDepthOfGlass;
  const oracle::PictureBounds bounds{.color_mean = 1e-6L, .plain_mean = 1e-5L, .unsure_share = 0.1};
  const oracle::Picture truth = oracle::render(scene, view);
  ASSERT_TRUE(compare_with(truth, scene, view, bounds).passes());
  // Each fault takes the compilation of three more kernels.
  for (const char* fault : test::cases_of<const char*>(
           {"refraction_inverted", "media_kept", "shadows_untinted", "absorption_per_face", "colors_swapped",
            "glass_seen_from_outside", "nested_faces_bend", "total_reflection_dark", "through_unweighted"},
           2)) {
    const test::FaultyShaders faulty(fault);
    EXPECT_FALSE(compare_with(truth, scene, view, bounds, faulty.shaders()).passes()) << fault;
  }
}

TEST_F(OraclePictureTest, MirrorsThatHangOnTheAngleAgreeWithTheOracle) {
  world::Scene scene = test::make_scene_of_everything(60);
  for (const size_t i : {0, 1, 3}) {
    scene.materials[i].phong().reflection = vec3(0.9F);
    scene.materials[i].phong().fresnel = true;
    scene.materials[i].phong().ior = 1.4F;
  }
  EXPECT_TRUE(agrees_with_oracle(scene, test::make_view(make_size())));
}

TEST_F(OraclePictureTest, ACameraInGlassAgreesWithTheOracle) {
  const world::Scene scene = test::make_scene_of_glass();
  View view = test::make_view(uvec2(64, 48));
  view.max_depth = kMaxDepthOfGlass;
  view.camera.yfov = 1.5F;
  // The eye is in two overlapping solids, in one inside another, in one that absorbs, and in a mesh.
  for (const vec3& eye : test::cases_of<vec3>(
           {vec3(0.95F, 1.55F, 3.05F), vec3(-0.8F, 1.75F, 3.4F), vec3(0.5F, 1.5F, 3.1F), vec3(0.1F, 0.6F, 3.95F)}, 2)) {
    view.camera.eye = eye;
    EXPECT_TRUE(compare(scene, view, {.color_mean = 1e-5L, .plain_mean = 1e-4L, .unsure_share = 0.3}).passes());
  }
}

TEST_F(OraclePictureTest, ClearCoatsAgreeWithTheOracle) {
  world::Scene scene = test::make_scene_of_everything(60);
  const auto coat = [&](size_t material, float clearcoat, float roughness) {
    auto& model = std::get<MetallicRoughness>(scene.materials[material].model);
    model.clearcoat = clearcoat;
    model.clearcoat_roughness = roughness;
    scene.materials[material].emissive = vec3(0.05F);
  };
  coat(4, 1.0F, 0.0F);
  coat(5, 0.5F, 0.3F);
  for (size_t i = 0; i < scene.objects.size(); ++i) scene.objects[i].material = i % 2 == 0 ? 4 : 5;
  EXPECT_TRUE(agrees_with_oracle(scene, test::make_view(make_size())));
}

TEST_F(OraclePictureTest, SheensAgreeWithTheOracle) {
  world::Scene scene = test::make_scene_of_everything(60);
  const auto cover = [&](size_t material, const vec3& color, float roughness) {
    auto& model = std::get<MetallicRoughness>(scene.materials[material].model);
    model.sheen_color = color;
    model.sheen_roughness = roughness;
    scene.materials[material].emissive = vec3(0.05F);
    return std::ref(model);
  };
  cover(4, vec3(1.0F, 0.7F, 0.2F), 0.2F);
  cover(5, vec3(0.6F), 0.8F).get().clearcoat = 0.5F;
  for (size_t i = 0; i < scene.objects.size(); ++i) scene.objects[i].material = i % 2 == 0 ? 4 : 5;
  EXPECT_TRUE(agrees_with_oracle(scene, test::make_view(make_size())));
}

/// The bounds for textures are chosen for pixels of this size.
constexpr uvec2 kSizeOfTextures(96, 72);

/// Bounds for textures. Texels differ from pixel to pixel, so a slightly wrong place or level shows nearly everywhere.
constexpr oracle::PictureBounds kOfTextures{
    .color_error = 0.005L, .color_mean = 1e-5L, .plain_mean = 5e-5L, .unsure_share = 0.002};

TEST_F(OraclePictureTest, TexturesOfMetallicRoughnessAgreeWithTheOracle) {
  EXPECT_TRUE(compare(test::make_gallery_of_metallic_roughness(), test::make_gallery_view(kSizeOfTextures), kOfTextures)
                  .passes());
}

TEST_F(OraclePictureTest, TexturesOfPhongAgreeWithTheOracle) {
  EXPECT_TRUE(compare(test::make_gallery_of_phong(), test::make_gallery_view(kSizeOfTextures), kOfTextures).passes());
}

TEST_F(OraclePictureTest, TexturesOfAlphaAgreeWithTheOracle) {
  EXPECT_TRUE(compare(test::make_gallery_of_alpha(), test::make_gallery_view(kSizeOfTextures), kOfTextures).passes());
}

/// Returns boards that transmit light, with films and grains, and with textures of all these properties. Light also
/// comes from behind, the wall mirrors the boards, and the sky above them is not uniform.
world::Scene make_gallery_of_rare_layers() {
  world::Scene scene = test::make_gallery_of_metallic_roughness();
  const auto texture_of = [&](ImageUse use) {
    const auto is_of = [&](const Texture& texture) { return scene.images[texture.image]->use == use; };
    return static_cast<uint32_t>(std::ranges::find_if(scene.textures, is_of) - scene.textures.begin());
  };
  for (size_t i = 1; i < scene.materials.size(); ++i) {
    auto* model = std::get_if<MetallicRoughness>(&scene.materials[i].model);
    if (model == nullptr) continue;
    model->diffuse_transmission = 0.7F;
    model->diffuse_transmission_color = vec3(0.9F, 0.6F, 0.3F);
    if (i % 2 == 0) model->diffuse_transmission_texture.texture = texture_of(ImageUse::kData);
    if (i % 3 == 0) model->diffuse_transmission_color_texture.texture = texture_of(ImageUse::kColor);
    model->iridescence = i % 4 == 1 ? 0.0F : 0.9F;
    model->iridescence_ior = i % 4 == 2 ? 2.0F : 1.3F;
    model->iridescence_thickness_minimum = i % 3 == 0 ? 500.0F : 150.0F;
    if (i % 2 == 1) model->iridescence_texture.texture = texture_of(ImageUse::kData);
    if (i % 3 != 1) model->iridescence_thickness_texture.texture = texture_of(ImageUse::kData);
    model->anisotropy = i % 4 == 3 ? 0.0F : 0.8F;
    model->anisotropy_rotation = 0.5F * static_cast<float>(i);
    if (i % 3 == 2) {
      model->anisotropy_texture = {.texture = texture_of(ImageUse::kData), .uv_set = static_cast<uint32_t>(i % 2)};
    }
  }
  scene.lights.push_back(test::make_sun(vec3(0.2F, -1, 0.5F), 2.0F));
  scene.environment.sky = GradientSky{.top = vec3(0.2F, 0.5F, 1),
                                      .horizon = vec3(1, 0.8F, 0.5F),
                                      .bottom = vec3(0.1F),
                                      .top_curve = 1,
                                      .bottom_curve = 1};
  return scene;
}

TEST_F(OraclePictureTest, RareLayersAgreeWithTheOracle) {
  const world::Scene scene = make_gallery_of_rare_layers();
  const View view = test::make_gallery_view(kSizeOfTextures);
  const oracle::Picture truth = oracle::render(scene, view);
  oracle::PictureBounds bounds = kOfTextures;
  // Highlights are narrow across a grain, so the oracle is not certain at their edges.
  bounds.unsure_share = 0.015;
  // The explained error includes the errors of the sky's maps.
  bounds.plain_mean = 1e-3L;
  EXPECT_TRUE(compare_with(truth, scene, view, bounds).passes());
  for (const char* fault : test::cases_of<const char*>(
           {"behind_seen_from_front", "grain_turned", "films_seen_from_above", "grain_unbent", "sky_behind_in_front"},
           2)) {
    const test::FaultyShaders faulty(fault);
    EXPECT_FALSE(compare_with(truth, scene, view, bounds, faulty.shaders()).passes()) << fault;
  }
}

// The device stores a sky as maps, with texels and a few roughnesses. White metals show P and nothing else.
TEST_F(OraclePictureTest, MapsOfSkiesAgreeWithTheOracle) {
  constexpr float kRoughnesses[] = {0.0F, 0.05F, 0.1F, 0.15F, 0.2F, 0.27F, 0.35F, 0.47F, 0.6F, 0.8F, 1.0F};
  const uint32_t side = test::is_thorough() ? 24 : 12;
  // The member rms is the largest root mean square error at one roughness, as a fraction of the sky's range.
  const struct {
    const char* name;
    Environment environment;
    oracle::Real rms;
  } kSkies[] = {{"gradient", test::make_gradient(), 0.010L},
                {"studio", test::make_studio(), 0.013L},
                {"panorama", test::make_panorama(), 0.008L}};
  for (const auto& sky : kSkies) {
    const oracle::Real range = oracle::Surroundings(sky.environment).range();
    const world::Scene scene = test::make_row_of_metals(sky.environment, kRoughnesses);
    const View view = test::make_view_of_row(std::size(kRoughnesses), side);
    const Image image = make_renderer(device(), scene).render(view).image;
    const oracle::Picture expected = oracle::render(scene, view);
    for (uint32_t ball = 0; ball < std::size(kRoughnesses); ++ball) {
      oracle::Real largest = 0;
      oracle::Real squares = 0;
      oracle::Real allowed = 0;
      uint32_t count = 0;
      for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = ball * side; x < (ball + 1) * side; ++x) {
          const oracle::Pixel& pixel = expected.at(x, y);
          if (!pixel.hit.exists()) continue;
          const auto off = glm::abs(oracle::Vector(image.pixels[y * view.size.x + x]) - pixel.color);
          const oracle::Real error = std::max({off.x, off.y, off.z});
          largest = std::max(largest, error);
          allowed = std::max(allowed, pixel.map_error);
          squares += error * error;
          ++count;
        }
      }
      const oracle::Real rms = std::sqrt(squares / count);
      std::printf("%s, roughness %.2f: of the range, largest %.4Lf, rms %.4Lf\n", sky.name,
                  static_cast<double>(kRoughnesses[ball]), largest / range, rms / range);
      EXPECT_LE(largest, allowed) << sky.name << " " << kRoughnesses[ball];
      EXPECT_LE(rms, sky.rms * range) << sky.name << " " << kRoughnesses[ball];
    }
  }
}

// The largest possible errors of the maps explain most differences of these pictures. The mean of the remaining
// differences is small.
TEST_F(OraclePictureTest, AGradientAgreesWithTheOracle) {
  const world::Scene scene = test::make_scene_under_sky(test::make_gradient());
  EXPECT_TRUE(
      compare(scene, test::make_gallery_view(make_size()), {.color_mean = 1e-5L, .plain_mean = 5e-4L}).passes());
}

TEST_F(OraclePictureTest, TheStudioAgreesWithTheOracle) {
  const world::Scene scene = test::make_scene_under_sky(test::make_studio());
  EXPECT_TRUE(
      compare(scene, test::make_gallery_view(make_size()), {.color_mean = 1e-5L, .plain_mean = 2e-3L}).passes());
}

TEST_F(OraclePictureTest, APanoramaAgreesWithTheOracle) {
  const world::Scene scene = test::make_scene_under_sky(test::make_panorama());
  EXPECT_TRUE(
      compare(scene, test::make_gallery_view(make_size()), {.color_mean = 1e-5L, .plain_mean = 5e-4L}).passes());
}

// The same bounds hold far from the origin, because intersections use coordinates relative to the primitive. The moved
// scene is rounded in the same way for device and oracle. Colours are not compared, because secondary rays start
// farther off the surface there.
TEST_F(OraclePictureTest, PrimaryHitsHoldFarFromTheOrigin) {
  world::Scene scene = test::make_scene_of_everything();
  View view = test::make_view(make_size());
  const vec3 offset(1e5F, -1e5F, 1e5F);
  for (world::Object& object : scene.objects) {
    std::visit([&](auto& shape) { move(shape, offset); }, object.shape);
  }
  for (Light& light : scene.lights) light.position += offset;
  view.camera.eye += offset;
  const oracle::PictureReport report = compare(scene, view);
  EXPECT_TRUE(report.non_finite.empty());
  EXPECT_TRUE(report.depth_errors.empty());
  EXPECT_LE(report.id_mismatches.size(), report.bounds.id_share * static_cast<double>(report.pixel_count));
  for (const oracle::IdMismatch& mismatch : report.id_mismatches) EXPECT_LE(mismatch.margin, report.bounds.id_margin);
}

}  // namespace
}  // namespace promin
