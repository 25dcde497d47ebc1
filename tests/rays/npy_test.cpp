// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/npy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include "support/temp_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Returns a file as numpy.save writes it: format 1.0 with a padded header, here not to a multiple of 64.
std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  const std::string header = dictionary + "\n";
  std::string file = "\x93NUMPY";
  file += version;
  file += '\0';
  const size_t length_bytes = version == 1 ? 2 : 4;
  for (size_t i = 0; i < length_bytes; ++i) file += static_cast<char>((header.size() >> (8 * i)) & 0xFF);
  return file + header + data;
}

std::string header_of(uint64_t count) {
  return "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(count) + ", 8), }";
}

std::string bytes_of(const std::vector<float>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

class NpyTest : public TempFolder {
 protected:
  fs::path write(const std::string& bytes) const {
    fs::path file = folder_ / "rays.npy";
    fs::remove(file);
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  std::string refusal(const std::string& bytes) const {
    const fs::path file = write(bytes);
    return message_of([&] { RayReader reader(file); });
  }
  std::string read(const fs::path& file) const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(NpyTest, ReadsRaysPieceByPiece) {
  const std::string data =
      bytes_of({0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 12, 13, 14, 15, 16, 17, 20, 21, 22, 23, 24, 25, 26, 27});
  RayReader reader(write(npy(header_of(3), data)));
  ASSERT_EQ(reader.count(), 3U);
  std::vector<Ray> rays(2);
  reader.read(rays);
  EXPECT_EQ(rays[0].origin, vec3(0, 1, 2));
  EXPECT_EQ(rays[0].tmin, 3.0F);
  EXPECT_EQ(rays[0].direction, vec3(4, 5, 6));
  EXPECT_EQ(rays[0].tmax, 7.0F);
  EXPECT_EQ(rays[1].origin, vec3(10, 11, 12));
  reader.read(std::span(rays).first(1));
  EXPECT_EQ(rays[0].direction, vec3(24, 25, 26));
}

/// The center is subtracted from positions before they are rounded, also for float32.
TEST_F(NpyTest, RaysOfDoublesAreRoundedOnce) {
  const dvec3 center(5280000.0, -1.0, 0.0);
  std::string header = header_of(5000);
  header.replace(header.find("<f4"), 3, "<f8");
  std::vector<double> numbers;
  for (int i = 0; i < 5000; ++i) {
    numbers.insert(numbers.end(), {5280000.0 + 0.001 * i, 0.1, i + 0.5, 0.1, 1.0, 2.0, 3.0, 1e300});
  }
  std::string data(numbers.size() * sizeof(double), '\0');
  std::memcpy(data.data(), numbers.data(), data.size());
  RayReader reader(write(npy(header, data)));
  ASSERT_EQ(reader.count(), 5000U);
  std::vector<Ray> rays(4999);
  reader.seek(1);
  reader.read(rays, center);
  EXPECT_EQ(rays.back().origin, vec3(dvec3(5280000.0 + 0.001 * 4999, 0.1, 4999.5) - center));
  EXPECT_EQ(rays.back().direction, vec3(1, 2, 3));
  EXPECT_EQ(rays.back().tmin, 0.1F);
  EXPECT_EQ(rays.back().tmax, std::numeric_limits<float>::infinity());

  RayReader floats(write(npy(header_of(1), bytes_of({5280000.5F, 1, 2, 3, 4, 5, 6, 7}))));
  floats.read(std::span(rays).first(1), center);
  EXPECT_EQ(rays[0].origin, vec3(0.5F, 2, 2));
}

TEST_F(NpyTest, ReadsEveryVersionAndSpelling) {
  const std::string data = bytes_of(std::vector<float>(8, 1.0F));
  for (const char version : {1, 2, 3}) EXPECT_EQ(refusal(npy(header_of(1), data, version)), "") << int{version};
  EXPECT_EQ(refusal(npy("{\"shape\":(1,8),\"fortran_order\":False,\"descr\":\"<f4\"}", data)), "");
  EXPECT_EQ(refusal(npy("{'shape': (1, 8,), 'fortran_order': False, 'descr': '<f4', 'more': [1, {}], }   ", data)), "");
  EXPECT_EQ(refusal(npy(header_of(0), "")), "");
}

TEST_F(NpyTest, RefusesWhatIsNoArrayOfRays) {
  const std::string data = bytes_of(std::vector<float>(8, 1.0F));
  EXPECT_THAT(refusal(""), HasProblem("rays.kind"));
  EXPECT_THAT(refusal("PK\x03\x04 an .npz"), HasProblem("rays.kind"));
  EXPECT_THAT(refusal(npy(header_of(1), data, 4)), HasProblem("rays.kind"));
  EXPECT_THAT(refusal(npy(header_of(1), data).substr(0, 30)), HasProblem("rays.short"));
  EXPECT_THAT(refusal(npy("{'descr': '<i4', 'fortran_order': False, 'shape': (1, 8), }", data)),
              HasProblem("rays.type '<i4'"));
  EXPECT_THAT(refusal(npy("{'descr': '<f4', 'fortran_order': True, 'shape': (1, 8), }", data)),
              HasProblem("rays.order"));
  for (const char* shape : {"(8,)", "(1, 7)", "(1, 1, 8)", "(-1, 8)", "()", "(1e3, 8)", "(99999999999999999999, 8)"}) {
    EXPECT_THAT(refusal(npy(std::string("{'descr': '<f4', 'fortran_order': False, 'shape': ") + shape + "}", data)),
                HasProblem("rays.shape"))
        << shape;
  }
  for (const char* header :
       {"", "[]", "{'descr': '<f4'}", "{'descr", "{'descr': '<f4', 'fortran_order': False, 'shape'", "{descr: 1}",
        "{'a': ((((", "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 8)} x"}) {
    EXPECT_THAT(refusal(npy(header, data)), HasProblem("rays.header")) << header;
  }
  // Text of the file is quoted on one line of harmless characters.
  const std::string loud =
      refusal(npy("{'descr': 'a\n\x1B" + std::string(500, 'b') + "', 'fortran_order': False, 'shape': (1, 8)}", data));
  EXPECT_THAT(loud, testing::AllOf(HasSubstr("'a??bbb"), HasSubstr("...")));
  EXPECT_LT(loud.size(), 400U);
  EXPECT_THAT(refusal(npy("{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (1, 8)}", data)),
              HasProblem("rays.header"));
  EXPECT_THAT(refusal(npy("{'descr': '<f4' 'fortran_order': False, 'shape': (1, 8)}", data)),
              HasProblem("rays.header"));
  const std::string message = refusal(npy(header_of(1), data + "x"));
  EXPECT_THAT(message, HasProblem("rays.short 1 33"));
  EXPECT_THAT(refusal(npy(header_of(2), data)), HasProblem("rays.short 2 32"));
  // The product of this number and 32 would overflow and give the correct size.
  EXPECT_THAT(refusal(npy(header_of((uint64_t{1} << 59) + 1), data)), HasProblem("rays.short 32"));
  EXPECT_THAT(message_of([&] { RayReader(folder_ / "none.npy"); }), HasProblem("file.missing"));
  EXPECT_THAT(message_of([&] { RayReader reader{folder_}; }), HasProblem("file.kind"));
}

// A header with a changed or missing byte gives rays or an error message, never a crash.
TEST_F(NpyTest, EveryDamagedHeaderEndsWell) {
  const std::string good = npy(header_of(1), bytes_of(std::vector<float>(8, 1.0F)));
  for (size_t i = 0; i < good.size() - 32; ++i) {
    for (const char flip : {'\x01', '\x20', '\x7F'}) {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ flip);
      refusal(bad);
    }
    refusal(good.substr(0, i));
  }
}

TEST_F(NpyTest, WritesAStructuredArray) {
  const fs::path file = folder_ / "hits.npy";
  std::vector<Hit> hits(3);
  hits[1] = {2.5F, 7, 9, 0.25F, 0.5F, vec3(0, 1, 0)};
  HitWriter writer(file, hits.size());
  writer.write(std::span(hits).first(2));
  writer.write(std::span(hits).last(1));
  EXPECT_FALSE(fs::exists(file));
  writer.commit();
  const std::string bytes = read(file);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
  const size_t header = 10 + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ(header % 64, 0U);
  EXPECT_EQ(bytes[header - 1], '\n');
  EXPECT_THAT(bytes, HasSubstr("'descr': [('t', '<f4'), ('object', '<i4'), ('primitive', '<i4'), ('u', '<f4'), "
                               "('v', '<f4'), ('normal', '<f4', (3,))], 'fortran_order': False, 'shape': (3,), }"));
  ASSERT_EQ(bytes.size(), header + 96);
  EXPECT_EQ(std::memcmp(bytes.data() + header, hits.data(), 96), 0);
}

TEST_F(NpyTest, RaysThatAreWrittenAreReadBack) {
  const fs::path file = folder_ / "rays.npy";
  std::vector<Ray> rays(3);
  rays[1] = {vec3(1, 2, 3), 0.5F, vec3(0, -1, 0), 7.0F};
  write_rays(file, rays);
  RayReader reader(file);
  std::vector<Ray> read(reader.count());
  ASSERT_EQ(read.size(), rays.size());
  reader.read(read);
  EXPECT_EQ(std::memcmp(read.data(), rays.data(), std::span(rays).size_bytes()), 0);
}

// The number becomes known at the end, and may be any number.
TEST_F(NpyTest, WritesAnArrayOfUnknownLength) {
  for (const size_t count : {0U, 3U, 123456U}) {
    const fs::path file = folder_ / "hits.npy";
    std::vector<Hit> hits(count);
    for (size_t i = 0; i < count; ++i) hits[i].object = static_cast<int32_t>(i);
    HitWriter writer(file);
    writer.write(hits);
    writer.commit();
    const std::string bytes = read(file);
    const size_t header = 10 + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
    EXPECT_EQ(header % 64, 0U);
    EXPECT_EQ(bytes[header - 1], '\n');
    EXPECT_THAT(bytes.substr(0, header), HasSubstr("'shape': (" + std::to_string(count) + ",), }"));
    ASSERT_EQ(bytes.size(), header + 32 * count);
    EXPECT_EQ(std::memcmp(bytes.data() + header, hits.data(), 32 * count), 0);
  }
}

TEST_F(NpyTest, WritesCountsAndOffsets) {
  CountWriter counts(folder_ / "counts.npy", 2);
  counts.write(std::array{7, -1});
  counts.commit();
  const std::string count_bytes = read(folder_ / "counts.npy");
  EXPECT_THAT(count_bytes, HasSubstr("'descr': '<i4', 'fortran_order': False, 'shape': (2,), }"));
  EXPECT_EQ(count_bytes.substr(count_bytes.size() - 8), std::string("\7\0\0\0\xFF\xFF\xFF\xFF", 8));
  OffsetWriter offsets(folder_ / "offsets.npy", 1);
  offsets.write(std::array{uint64_t{1} << 40});
  offsets.commit();
  const std::string offset_bytes = read(folder_ / "offsets.npy");
  EXPECT_THAT(offset_bytes, HasSubstr("'descr': '<u8', 'fortran_order': False, 'shape': (1,), }"));
  EXPECT_EQ(offset_bytes.substr(offset_bytes.size() - 8), std::string("\0\0\0\0\0\1\0\0", 8));
}

TEST_F(NpyTest, WithoutACommitTheOldFileStays) {
  const fs::path file = folder_ / "hits.npy";
  std::ofstream(file) << "old";
  { HitWriter writer(file, 5); }
  EXPECT_EQ(read(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

}  // namespace
}  // namespace promin
