// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "records.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "picture_arrays.h"
#include "promin/error.h"
#include "scene/members.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

template <typename Geometries>
struct WithoutMesh;
template <typename... Shapes>
struct WithoutMesh<std::variant<Mesh, Shapes...>> {
  using Type = std::variant<Shapes...>;
};
using Shape = WithoutMesh<Geometry>::Type;

template <int N, typename T>
using Vec = glm::vec<N, T, glm::defaultp>;

template <typename T>
T read_one(const nb::dict& record);

/// Sets the variant to the alternative that the record's "kind" names, one of the given names.
template <typename... Kinds>
void read_kind(std::variant<Kinds...>& value, Names names, const std::string& kind, const std::string& what,
               const nb::dict& record) {
  const size_t place = find_name(names, kind, what);
  size_t index = 0;
  const auto read = [&]<typename Kind>(std::type_identity<Kind>) {
    if (index++ == place) value = read_one<Kind>(record);
  };
  (read(std::type_identity<Kinds>()), ...);
}

/// Fills a struct from a dict.
class Reader {
 public:
  explicit Reader(const nb::dict& record) : record_(record) {}

  /// Reads a number, an enumerator by its name, or a struct from a dict.
  template <typename T>
  void field(const std::string& name, T& value) const {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(find_name(names_of(T()), find_text(name), name));
    } else if constexpr (std::is_class_v<T>) {
      value = read_one<T>(convert<nb::dict>(find(name), name, "a record"));
    } else {
      value = convert<T>(find(name), name, "a number");
    }
  }
  void field(const std::string& name, std::string& value) const { value = find_text(name); }
  void field(const std::string& name, bool& value) const { value = convert<bool>(find(name), name, "True or False"); }
  template <int N, typename T>
  void field(const std::string& name, Vec<N, T>& value) const {
    const auto numbers = convert<std::array<T, N>>(find(name), name, N == 2 ? "two numbers" : "three numbers");
    for (int i = 0; i < N; ++i) value[i] = numbers[static_cast<size_t>(i)];
  }
  void field(const std::string& name, TextureSlot& value) const {
    std::optional<TextureSlot> slot;
    field(name, slot);
    value = slot.value_or(TextureSlot());
  }
  template <typename T>
  void field(const std::string& name, std::optional<T>& value) const {
    value.reset();
    if (!find(name).is_none()) value = read_one<T>(convert<nb::dict>(find(name), name, "a record"));
  }
  void field(const std::string& name, MaterialModel& value) const {
    read_kind(value, kModelNames, find_text(name), "model of materials", record_);
  }
  void field(const std::string& name, SkyModel& value) const {
    value = {};
    if (find(name).is_none()) return;
    const auto sky = convert<nb::dict>(find(name), name, "a record");
    read_kind(value, kSkyNames, Reader(sky).find_text("kind"), "kind of sky", sky);
  }
  void field(const std::string& name, std::shared_ptr<const Image>& value) const {
    PictureArray pixels;
    if (!nb::try_cast(find(name), pixels, false)) {
      throw UsageError(
          {"python.value.wrong", name + " is not an array of (rows, columns, 3) float32", "", "convert it"});
    }
    value = std::make_shared<const Image>(read_image_array(pixels));
  }

 private:
  nb::object find(const std::string& name) const {
    if (!record_.contains(name.c_str()))
      throw UsageError({"python.name.unknown", "the record has no " + name, "", "add it"});
    return record_[name.c_str()];
  }
  std::string find_text(const std::string& name) const { return convert<std::string>(find(name), name, "text"); }
  template <typename T>
  static T convert(const nb::object& value, const std::string& name, const char* kind) {
    T result;
    // A number that would be cut off, such as 1.5 for an integer, is an error: Python's int() decides.
    if (nb::try_cast<T>(value, result)) return result;
    // Python cuts the text, because it cuts between characters. A cut inside a character's bytes gives invalid text.
    const auto shown = nb::cast<std::string>(nb::str(nb::repr(value))[nb::slice(0, 80)]);
    throw UsageError({"python.value.wrong", name + " is " + shown + ", not " + kind, "", std::string("give ") + kind});
  }

  const nb::dict& record_;
};

template <typename T>
T read_one(const nb::dict& record) {
  T value;
  const Reader reader(record);
  visit_members(reader, value);
  return value;
}

/// Fills a dict from a struct.
class Writer {
 public:
  template <typename T>
  static nb::dict write_one(T value) {
    Writer writer;
    visit_members(writer, value);
    return writer.record_;
  }

  /// Writes a number, an enumerator as its name, or a struct as a dict.
  template <typename T>
  void field(const std::string& name, T& value) {
    if constexpr (std::is_enum_v<T>) {
      put(name, nb::cast(std::string(names_of(value)[static_cast<size_t>(value)])));
    } else if constexpr (std::is_class_v<T>) {
      put(name, write_one(value));
    } else {
      put(name, nb::cast(value));
    }
  }
  void field(const std::string& name, std::string& value) { put(name, nb::cast(value)); }
  template <typename T>
  void field(const std::string& name, std::optional<T>& value) {
    put(name, value ? nb::object(write_one(*value)) : nb::none());
  }
  template <int N, typename T>
  void field(const std::string& name, Vec<N, T>& value) {
    std::array<T, N> numbers;
    for (int i = 0; i < N; ++i) numbers[static_cast<size_t>(i)] = value[i];
    put(name, nb::tuple(nb::cast(numbers)));
  }
  void field(const std::string& name, TextureSlot& value) {
    put(name, value.exists() ? nb::object(write_one(value)) : nb::none());
  }
  void field(const std::string& name, MaterialModel& value) {
    put(name, nb::cast(std::string(kModelNames[value.index()])));
    std::visit([&](const auto& model) { record_.update(write_one(model)); }, value);
  }
  void field(const std::string& name, SkyModel& value) {
    nb::dict sky = std::visit([](const auto& one) { return write_one(one); }, value);
    sky["kind"] = std::string(kSkyNames[value.index()]);
    put(name, value.index() == 0 ? nb::none() : nb::object(sky));
  }
  void field(const std::string& name, std::shared_ptr<const Image>& value) { put(name, write_image_array(*value)); }

 private:
  void put(const std::string& name, const nb::object& value) { record_[name.c_str()] = value; }

  nb::dict record_;
};

template <typename T>
std::optional<T> read_optional(const nb::dict& record, const std::string& name) {
  if (!record.contains(name.c_str()) || record[name.c_str()].is_none()) return {};
  T value{};
  Reader(record).field(name, value);
  return value;
}

}  // namespace

size_t find_name(Names names, const std::string& name, const std::string& what) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<size_t>(found - names.begin());
  std::string all;
  for (const std::string_view one : names) all += (all.empty() ? "" : ", ") + std::string(one);
  throw UsageError({"python.name.unknown", "there is no " + what + " \"" + name + "\"", "", "choose one of: " + all});
}

std::optional<float> read_real(const nb::dict& record, const std::string& name) {
  return read_optional<float>(record, name);
}

std::optional<uint32_t> read_whole(const nb::dict& record, const std::string& name) {
  return read_optional<uint32_t>(record, name);
}

Light read_light(const nb::dict& record) {
  return read_one<Light>(record);
}

nb::dict write(const Light& light) {
  return Writer::write_one(light);
}

Material read_material(const nb::dict& record) {
  return read_one<Material>(record);
}

nb::dict write(const Material& material) {
  return Writer::write_one(material);
}

Camera read_camera(const nb::dict& record) {
  return read_one<Camera>(record);
}

nb::dict write(const Camera& camera) {
  return Writer::write_one(camera);
}

Environment read_environment(const nb::dict& record) {
  return read_one<Environment>(record);
}

nb::dict write(const Environment& environment) {
  return Writer::write_one(environment);
}

DisplayTransform read_display(const nb::dict& record) {
  return read_one<DisplayTransform>(record);
}

nb::dict write(const DisplayTransform& display) {
  return Writer::write_one(display);
}

ExrOptions read_exr_options(const nb::dict& record) {
  return read_one<ExrOptions>(record);
}

nb::dict write(const ExrOptions& options) {
  return Writer::write_one(options);
}

View read_view(const nb::dict& record) {
  return read_one<View>(record);
}

nb::dict write(const View& view) {
  return Writer::write_one(view);
}

nb::dict write(const ErrorTarget& target) {
  return Writer::write_one(target);
}

RenderMode read_mode(const nb::dict& record) {
  return read_one<RenderMode>(record);
}

Geometry read_shape(const std::string& kind, const nb::dict& record) {
  Shape shape;
  read_kind(shape, Names(kShapeNames).subspan(1), kind, "shape", record);
  return std::visit([](const auto& one) -> Geometry { return one; }, shape);
}

}  // namespace promin::python
