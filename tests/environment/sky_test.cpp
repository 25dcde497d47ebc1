// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "core/rounding.h"
#include "environment/pack_sky.h"
#include "environment/read_panorama.h"
#include "environment/sky_radiance.h"
#include "promin/lighting.h"
#include "promin/validate.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

using std::numbers::pi;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kRoughnesses[] = {0.0, 0.1, 0.2, 0.35, 0.6, 1.0};
/// The rounding of half floats, which have 11 bits.
constexpr double kHalfRounding = 0x1p-11;

const dvec3 kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

Environment make_panorama(const uvec2& size, const std::function<dvec3(const dvec3&)>& radiance) {
  auto image = std::make_shared<Image>();
  image->size = size;
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) {
      const double from_top = pi * (y + 0.5) / size.y;
      const double right = 2.0 * pi * ((x + 0.5) / size.x - 0.5);
      image->pixels.emplace_back(
          radiance({std::sin(from_top) * std::sin(right), std::cos(from_top), -std::sin(from_top) * std::cos(right)}));
    }
  }
  Environment environment;
  environment.sky = Panorama{image};
  return environment;
}

std::vector<dvec3> make_directions(size_t count) {
  std::mt19937 generator(1);
  const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
  std::vector<dvec3> directions;
  for (size_t i = 0; i < count; ++i) {
    const double y = 2.0 * uniform() - 1.0;
    const double azimuth = 2.0 * pi * uniform();
    const double radius = std::sqrt(1.0 - y * y);
    directions.emplace_back(radius * std::sin(azimuth), y, radius * std::cos(azimuth));
  }
  return directions;
}

/// Returns many directions, each for the same solid angle.
std::vector<dvec3> spread_directions(int count) {
  std::vector<dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / count;
    const double azimuth = 2.0 * pi * std::fmod(i * std::numbers::phi, 1.0);
    const double radius = std::sqrt(1.0 - y * y);
    directions.emplace_back(radius * std::sin(azimuth), y, radius * std::cos(azimuth));
  }
  return directions;
}

dvec3 irradiance_over_pi(const PackedSky& sky, const dvec3& n) {
  const double basis[9] = {
      1.0, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3.0 * n.z * n.z - 1.0, n.z * n.x, n.x * n.x - n.y * n.y};
  dvec3 sum(0.0);
  for (int i = 0; i < 9; ++i) sum += basis[i] * dvec3(vec3(sky.irradiance[i]));
  return sum;
}

dvec3 integrate_irradiance(const Environment& environment, const dvec3& normal) {
  constexpr int kCount = 40000;
  dvec3 sum(0.0);
  for (const dvec3& direction : spread_directions(kCount)) {
    sum += std::max(glm::dot(direction, normal), 0.0) * sky_radiance(environment, direction);
  }
  return 4.0 / kCount * sum;
}

/// Returns the mean over the lobe of GGX around its normal, as an integral over half vectors.
dvec3 integrate_lobe(const Environment& environment, double roughness, const dvec3& normal) {
  if (roughness == 0.0) return sky_radiance(environment, normal);
  constexpr int kCount = 5000;
  const double alpha2 = std::pow(roughness, 4.0);
  const dvec3 other = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
  const dvec3 u = glm::normalize(glm::cross(normal, other));
  const dvec3 v = glm::cross(normal, u);
  dvec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double xi = (i + 0.5) / kCount;
    const double angle = std::acos(std::sqrt((1.0 - xi) / (1.0 + (alpha2 - 1.0) * xi)));
    const double azimuth = 2.0 * pi * std::fmod(i * std::numbers::phi, 1.0);
    const double weight = std::cos(2.0 * angle);
    if (weight <= 0.0) continue;
    const dvec3 light = std::sin(2.0 * angle) * (std::cos(azimuth) * u + std::sin(azimuth) * v) + weight * normal;
    sum += weight * sky_radiance(environment, light);
    weights += weight;
  }
  return sum / weights;
}

/// A packed sky as the device reads it.
class Levels {
 public:
  explicit Levels(const PackedSky& sky) : sky_(sky) {}

  dvec3 look_up(uint32_t level, const dvec3& direction) const {
    size_t first = 0;
    for (uint32_t i = 0; i < level; ++i) first += entries_of(side_of_level(sky_.side, i));
    const uint32_t side = side_of_level(sky_.side, level);
    const dvec3 p = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    const dvec2 seen(p.x, p.z);
    const dvec2 folded((p.x < 0.0 ? -1.0 : 1.0) * (1.0 - std::abs(p.z)),
                       (p.z < 0.0 ? -1.0 : 1.0) * (1.0 - std::abs(p.x)));
    const dvec2 texel = (0.5 + 0.5 * (p.y < 0.0 ? folded : seen)) * static_cast<double>(side) + 0.5;
    const auto x = static_cast<uint32_t>(texel.x);
    const auto y = static_cast<uint32_t>(texel.y);
    const size_t entry = first + static_cast<size_t>(y) * (side + 1) + x;
    return glm::mix(mix_entry(entry, texel.x - x), mix_entry(entry + side + 1, texel.x - x), texel.y - y);
  }

  static size_t entries_of(uint32_t side) { return size_t{side + 1} * (side + 2); }

 private:
  dvec3 mix_entry(size_t entry, double across) const {
    const uvec4& words = sky_.texels.at(entry);
    const vec2 a = glm::unpackHalf2x16(words.x);
    const vec2 b = glm::unpackHalf2x16(words.y);
    const vec2 c = glm::unpackHalf2x16(words.z);
    return glm::mix(dvec3(a.x, a.y, b.x), dvec3(b.y, c.x, c.y), across);
  }

  const PackedSky& sky_;
};

double max_error(const dvec3& a, const dvec3& b) {
  const dvec3 difference = glm::abs(a - b);
  return std::max({difference.x, difference.y, difference.z});
}

// Light without bands beyond the second, so that the coefficients represent all of it.
dvec3 smooth_light(const dvec3& d) {
  return {2.0 + d.x - 0.5 * d.y * d.z, 2.0 + d.y + 0.5 * d.x * d.y + 0.25 * d.z * d.x,
          2.0 - d.z + 0.5 * (d.x * d.x - d.y * d.y) + 0.25 * (3.0 * d.z * d.z - 1.0)};
}

TEST(SkyTest, IrradianceIsTheIntegral) {
  const Environment smooth = make_panorama({256, 128}, smooth_light);
  const PackedSky sky = pack_sky(smooth);
  for (const dvec3& normal : make_directions(20)) {
    EXPECT_LT(max_error(irradiance_over_pi(sky, normal), integrate_irradiance(smooth, normal)), 2e-3);
  }
}

TEST(SkyTest, IrradianceOfAConstantIsTheConstant) {
  const PackedSky sky = pack_sky(make_panorama({8, 4}, [](const dvec3&) { return dvec3(0.25, 0.5, 3.0); }));
  EXPECT_EQ(sky.irradiance[0], vec4(0.25F, 0.5F, 3.0F, 0.0F));
  for (int i = 1; i < 9; ++i) EXPECT_LT(max_abs_component(vec3(sky.irradiance[i])), 2e-4F) << i;
}

TEST(SkyTest, IrradianceOfAGradientIsTheIntegral) {
  Environment environment;
  environment.sky = GradientSky{vec3(0.2F, 0.4F, 1.0F), vec3(0.8F), vec3(0.3F, 0.2F, 0.1F), 0.7F, 0.3F};
  const PackedSky sky = pack_sky(environment);
  // The coefficients lack the bands beyond the second.
  for (const dvec3& normal : make_directions(10)) {
    EXPECT_LT(max_error(irradiance_over_pi(sky, normal), integrate_irradiance(environment, normal)), 0.01);
  }
}

// All light of a sun arrives, even if the sun is small. For example, the coefficients of the first band contain it,
// multiplied by the cosine to the sun.
TEST(SkyTest, ASinglePixelLosesNoLight) {
  constexpr uint32_t kWidth = 3000;
  constexpr uint32_t kHeight = 1500;
  for (const uint32_t row : {100U, 749U, 1201U}) {
    const auto image = std::make_shared<Image>();
    image->size = {kWidth, kHeight};
    image->pixels.assign(size_t{kWidth} * kHeight, vec3(0.0F));
    image->at(1700, row) = vec3(1e6F);
    Environment environment;
    environment.sky = Panorama{image};
    const PackedSky sky = pack_sky(environment);
    const double solid_angle = 2.0 * pi / kWidth * (std::cos(pi * row / kHeight) - std::cos(pi * (row + 1) / kHeight));
    const double from_top = pi * (row + 0.5) / kHeight;
    const double right = 2.0 * pi * (1700.5 / kWidth - 0.5);
    const dvec3 sun(std::sin(from_top) * std::sin(right), std::cos(from_top), -std::sin(from_top) * std::cos(right));
    const double light = 1e6 * solid_angle;
    const double mean = light / (4.0 * pi);
    EXPECT_NEAR(sky.irradiance[0].x, mean, 0.02 * mean) << row;
    EXPECT_NEAR(sky.irradiance[1].x, 2.0 * mean * sun.y, 0.04 * mean) << row;
    EXPECT_NEAR(sky.irradiance[2].x, 2.0 * mean * sun.z, 0.04 * mean) << row;
    EXPECT_NEAR(sky.irradiance[3].x, 2.0 * mean * sun.x, 0.04 * mean) << row;
    EXPECT_NEAR(sky.irradiance[4].x, 3.75 * mean * sun.x * sun.y, 0.08 * mean) << row;
    EXPECT_NEAR(sky.irradiance[6].x, 0.3125 * mean * (3.0 * sun.z * sun.z - 1.0), 0.02 * mean) << row;
    EXPECT_GT(Levels(sky).look_up(0, sun).x, 0.0);
  }
}

TEST(SkyTest, TheBrightestIsTheLargestHalf) {
  const PackedSky sky = pack_sky(make_panorama({8, 4}, [](const dvec3&) { return dvec3(1e9, 65504.0, 1.0); }));
  for (uint32_t level = 0; level < 6; ++level) {
    EXPECT_EQ(Levels(sky).look_up(level, {0.1, 0.2, 0.3}), dvec3(65504.0, 65504.0, 1.0)) << level;
  }
}

TEST(SkyTest, AConstantStaysOneAtEveryLevel) {
  const dvec3 color(0.3, 1.0, 7.0);
  const PackedSky sky = pack_sky(make_panorama({1024, 512}, [&](const dvec3&) { return color; }));
  EXPECT_EQ(sky.side, 512U);
  for (uint32_t level = 0; level < 6; ++level) {
    for (const dvec3& direction : make_directions(1000)) {
      const dvec3 seen = Levels(sky).look_up(level, direction) / color;
      ASSERT_LE(max_error(seen, dvec3(1.0)), kHalfRounding) << level;
    }
  }
}

TEST(SkyTest, LevelsAreTheMeansOverLobes) {
  Environment studio;
  studio.sky = Studio{};
  Environment gradient;
  gradient.sky = GradientSky{};
  const Environment patches = make_panorama({1024, 512}, [](const dvec3& d) {
    return dvec3(std::sin(9.0 * d.x) + 1.0, d.y > 0.5 ? 2.0 : 0.5,
                 glm::dot(d, dvec3(0.6, 0.0, 0.8)) > 0.97 ? 20.0 : 0.5);
  });
  const double bounds[6] = {0.06, 0.03, 0.02, 0.02, 0.01, 0.01};
  for (const Environment* environment : std::initializer_list<const Environment*>{&studio, &gradient, &patches}) {
    const PackedSky sky = pack_sky(*environment);
    for (uint32_t level = 0; level < 6; ++level) {
      double squares = 0.0;
      double most = 0.0;
      const std::vector<dvec3> directions = make_directions(100);
      for (const dvec3& direction : directions) {
        const dvec3 wanted = integrate_lobe(*environment, kRoughnesses[level], direction);
        const double error = max_error(Levels(sky).look_up(level, direction), wanted);
        squares += error * error;
        most = std::max({most, wanted.x, wanted.y, wanted.z});
      }
      EXPECT_LT(std::sqrt(squares / static_cast<double>(directions.size())), bounds[level] * most) << level;
    }
  }
}

// The test moves along the square's edges, which are half planes below the horizon, and along the fold, which is the
// horizon.
TEST(SkyTest, NothingJumpsOverTheSeams) {
  const PackedSky sky = pack_sky(make_panorama({512, 256}, smooth_light));
  constexpr double kStep = 1e-7;
  for (uint32_t level = 0; level < 6; ++level) {
    for (const dvec3& direction : make_directions(300)) {
      for (int axis = 0; axis < 3; ++axis) {
        dvec3 before = direction;
        if (axis != 1) before.y = -std::abs(before.y);
        before[axis] = -kStep;
        dvec3 behind = before;
        behind[axis] = kStep;
        const dvec3 seen = Levels(sky).look_up(level, before);
        ASSERT_LT(max_error(seen, Levels(sky).look_up(level, behind)), 8.0 * kHalfRounding)
            << level << " " << axis << " " << direction.x << " " << direction.y << " " << direction.z;
        if (level == 0) {
          ASSERT_LT(max_error(seen, smooth_light(glm::normalize(before))), 0.03);
        }
      }
    }
  }
}

TEST(SkyTest, ThePicturesMiddleIsAheadAndItsQuarterIsRight) {
  // The panorama has six patches. A patch's colour has 1 in the channel of its axis, and 2 if the direction is
  // negative.
  const Environment patches = make_panorama({64, 32}, [](const dvec3& d) {
    const dvec3 size = glm::abs(d);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    dvec3 color(0.0);
    color[axis] = d[axis] < 0.0 ? 2.0 : 1.0;
    return color;
  });
  const Image& image = *std::get<Panorama>(patches.sky).image;
  EXPECT_EQ(image.at(32, 16), vec3(0, 0, 2)) << "the middle is -Z";
  EXPECT_EQ(image.at(48, 16), vec3(1, 0, 0)) << "a quarter to the right is +X";
  EXPECT_EQ(image.at(0, 0), vec3(0, 1, 0)) << "the top is +Y";
  for (const dvec3& axis : kAxes) {
    const dvec3 wanted = glm::max(axis, -2.0 * axis);
    EXPECT_LT(max_error(sky_radiance(patches, 5.0 * axis), wanted), 1e-9);
    EXPECT_LT(max_error(Levels(pack_sky(patches)).look_up(0, axis), wanted), 1e-2);
  }
}

TEST(SkyTest, RotationTurnsFromZToX) {
  Environment turned = make_panorama({512, 256}, smooth_light);
  const Environment plain = turned;
  turned.rotation = 0.5F * std::numbers::pi_v<float>;
  turned.intensity = 3.0F;
  const dvec3 direction = glm::normalize(dvec3(0.3, 0.2, 0.9));
  // The rotation moves the patch in front of the viewer to the right.
  const dvec3 moved(direction.z, direction.y, -direction.x);
  EXPECT_LT(max_error(sky_radiance(turned, moved), 3.0 * sky_radiance(plain, direction)), 1e-6);
  const PackedSky sky = pack_sky(turned);
  EXPECT_LT(max_error(Levels(sky).look_up(3, moved), 3.0 * Levels(pack_sky(plain)).look_up(3, direction)), 0.03);
  EXPECT_LT(max_error(irradiance_over_pi(sky, moved), 3.0 * irradiance_over_pi(pack_sky(plain), direction)), 0.01);
}

TEST(SkyTest, ItStandsOnUp) {
  Environment standing = make_panorama({512, 256}, smooth_light);
  standing.rotation = 0.7F;
  Environment lying = standing;
  const dvec3 direction = glm::normalize(dvec3(0.3, 0.2, 0.9));
  const std::pair<vec3, dvec3> kTurned[] = {
      {vec3(0, 0, 1), dvec3(direction.x, -direction.z, direction.y)},
      {vec3(0, -1, 0), dvec3(-direction.x, -direction.y, direction.z)},
      {vec3(1, 0, 0), dvec3(direction.y, -direction.x, direction.z)},
      {vec3(0.0F, 0.6F, 0.8F),
       dvec3(direction.x, 0.6 * direction.y - 0.8 * direction.z, 0.8 * direction.y + 0.6 * direction.z)}};
  for (const auto& [up, moved] : kTurned) {
    lying.up = up;
    EXPECT_LT(max_error(sky_radiance(lying, moved), sky_radiance(standing, direction)), 1e-6) << up.x << up.y << up.z;
  }
  EXPECT_LT(max_error(irradiance_over_pi(pack_sky(lying), kTurned[3].second),
                      irradiance_over_pi(pack_sky(standing), direction)),
            0.01);
}

TEST(SkyTest, AGradientHasItsColorsAtTheEnds) {
  Environment environment;
  const GradientSky gradient = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), 1.0F, 0.5F};
  environment.sky = gradient;
  EXPECT_LT(max_error(sky_radiance(environment, {0, 1, 0}), dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(max_error(sky_radiance(environment, {1, 0, 3}), dvec3(0, 1, 0)), 1e-12);
  EXPECT_LT(max_error(sky_radiance(environment, {0, -1, 0}), dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(max_error(sky_radiance(environment, {0, 1, 1}), dvec3(0.5, 0.5, 0)), 1e-12) << "linear in the angle";
  EXPECT_LT(max_error(sky_radiance(environment, {0, -1, 1}), dvec3(0, 0.25, 0.75)), 1e-12) << "the horizon is narrow";
}

// The test checks the figures of docs/model.md.
TEST(SkyTest, TheStudioLightsAsItIsDescribed) {
  Environment studio;
  const float front = 0.7F;
  studio.sky = Studio{front};
  const Light light = make_studio_light(front);
  EXPECT_EQ(light.kind, LightKind::kDirectional);
  const double s = std::sin(front);
  const double c = std::cos(front);
  const struct {
    dvec3 normal;
    double lamps, source;
  } walls[] = {{{s, 0, c}, 0.36, 0.27},  {{0, 1, 0}, 0.56, 0.28},  {{c, 0, -s}, 0.36, 0.0},
               {{-c, 0, s}, 0.35, 0.19}, {{-s, 0, -c}, 0.35, 0.0}, {{0, -1, 0}, 0.15, 0.0}};
  const PackedSky sky = pack_sky(studio);
  for (const auto& wall : walls) {
    EXPECT_NEAR(integrate_irradiance(studio, wall.normal).x, wall.lamps, 0.006);
    EXPECT_NEAR(irradiance_over_pi(sky, wall.normal).x, wall.lamps, 0.06);
    const double cosine = std::max(-glm::dot(wall.normal, dvec3(light.direction)), 0.0);
    EXPECT_NEAR(cosine * static_cast<double>(light.diffuse.x) / pi, wall.source, 0.005);
  }
}

TEST(SkyTest, ThreadsChangeNoBit) {
  Environment studio;
  studio.sky = Studio{};
  const Environment panorama = make_panorama({3001, 1203}, smooth_light);
  for (const Environment* environment : std::initializer_list<const Environment*>{&studio, &panorama}) {
    const PackedSky one = pack_sky(*environment, 1);
    const PackedSky many = pack_sky(*environment, 7);
    EXPECT_EQ(one.side, many.side);
    EXPECT_TRUE(one.texels == many.texels);
    EXPECT_TRUE(one.irradiance == many.irradiance);
    EXPECT_EQ(one.texels.size() * sizeof(uvec4), packed_sky_bytes(*environment));
  }
}

TEST(SkyTest, WithoutASkyThereIsNothing) {
  Environment environment;
  environment.ambient = vec3(0.5F);
  const PackedSky sky = pack_sky(environment);
  EXPECT_EQ(sky.side, 0U);
  EXPECT_THAT(sky.texels, IsEmpty());
  EXPECT_EQ(packed_sky_bytes({}), 0U);
  EXPECT_EQ(sky_radiance(environment, {0, 0, 1}), dvec3(0.5));
}

TEST(SkyTest, WrongSkiesAreProblems) {
  const auto problems_of = [](const auto& sky) {
    Environment environment;
    environment.sky = sky;
    return validate(environment);
  };
  EXPECT_THAT(problems_of(Studio{}), IsEmpty());
  EXPECT_THAT(problems_of(Studio{std::numeric_limits<float>::infinity()}), SizeIs(1));
  EXPECT_THAT(problems_of(GradientSky{}), IsEmpty());
  EXPECT_THAT(problems_of(GradientSky{.top_curve = 0.0F}), SizeIs(1));
  EXPECT_THAT(problems_of(GradientSky{.horizon = vec3(-1.0F)}), SizeIs(1));
  EXPECT_THAT(problems_of(Panorama{}), SizeIs(1));
  EXPECT_THAT(problems_of(Panorama{std::make_shared<Image>()}), SizeIs(1));
  EXPECT_THAT(problems_of(Panorama{std::make_shared<Image>(Image{{2, 2}, {vec3(0)}})}), SizeIs(1));
  EXPECT_THAT(problems_of(Panorama{std::make_shared<Image>(Image{{1, 1}, {vec3(NAN)}})}), SizeIs(1));
  Environment environment;
  environment.rotation = NAN;
  environment.intensity = -1.0F;
  EXPECT_THAT(validate(environment), SizeIs(2));
}

class ReadPanoramaTest : public TempFolder {
 protected:
  std::string refusal_of(const uvec2& size, const vec3& pixel) const {
    write_image(folder_ / "sky.exr", {size, std::vector<vec3>(size_t{size.x} * size.y, pixel)});
    return message_of([&] { read_panorama(folder_ / "sky.exr", warnings_); });
  }

  mutable std::vector<std::string> warnings_;
};

TEST_F(ReadPanoramaTest, PicturesThatAreNoneAreRefusedInASentence) {
  EXPECT_EQ(refusal_of({4, 2}, vec3(1e4F)), "");
  EXPECT_THAT(refusal_of({4, 2}, vec3(NAN)), HasProblem("scene.panorama.pixel"));
  EXPECT_THAT(refusal_of({4, 2}, vec3(0.0F, INFINITY, 0.0F)), HasProblem("scene.panorama.pixel (G inf 0, 0"));
  EXPECT_THAT(refusal_of({4, 2}, vec3(0.0F, 0.0F, -INFINITY)), HasProblem("scene.panorama.pixel (B -inf"));
  EXPECT_THAT(warnings_, IsEmpty());
  EXPECT_THAT(refusal_of({16385, 1}, vec3(1)), HasProblem("picture.large"));
  EXPECT_THAT(refusal_of({1, 8193}, vec3(1)), HasProblem("picture.large 16384x8192"));
  EXPECT_THAT(message_of([&] { read_panorama(folder_ / "none.hdr", warnings_); }), HasSubstr("none.hdr"));
  std::ofstream(folder_ / "broken.hdr") << "#?RADIANCE";
  EXPECT_THAT(message_of([&] { read_panorama(folder_ / "broken.hdr", warnings_); }), HasSubstr("broken.hdr"));
}

TEST_F(ReadPanoramaTest, NegativeNumbersCountAsZero) {
  Image image = {{3, 2}, std::vector<vec3>(6, vec3(0.5F))};
  image.at(2, 1) = vec3(-0.25F, 0.5F, -1.0F);
  write_image(folder_ / "sky.exr", image);
  const Panorama panorama = read_panorama(folder_ / "sky.exr", warnings_);
  EXPECT_EQ(panorama.image->at(2, 1), vec3(0.0F, 0.5F, 0.0F));
  EXPECT_EQ(panorama.image->at(1, 1), vec3(0.5F));
  EXPECT_THAT(warnings_, testing::ElementsAre(testing::EndsWith(
                             "sky.exr are negative, the first -0.25 in pixel 2, 1; they are read as 0")));
  EXPECT_THAT(warnings_.front(), testing::StartsWith("2 numbers of "));
}

TEST_F(ReadPanoramaTest, OtherFormatsAreOfTheCurveOfSrgb) {
  const Image image = {{2, 1}, {vec3(0.2F, 0.5F, 1.0F), vec3(0.0F, 0.001F, 0.7F)}};
  write_image(folder_ / "sky.png", image);
  write_image(folder_ / "sky.exr", image);
  for (const char* name : {"sky.png", "sky.exr"}) {
    const Panorama panorama = read_panorama(folder_ / name, warnings_);
    for (size_t i = 0; i < 2; ++i) {
      EXPECT_LT(max_abs_component(panorama.image->pixels[i] - image.pixels[i]), 0.005F) << name;
    }
  }
}

}  // namespace
}  // namespace promin
