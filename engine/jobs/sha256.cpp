// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "jobs/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <vector>

#include "core/file.h"
#include "promin/error.h"

namespace promin::jobs {
namespace {

void check(int result) {
  if (result != 1)
    throw RunError({"hash.failed", "OpenSSL's libcrypto cannot compute SHA-256", "", "install it again"});
}

}  // namespace

struct Sha256::Context {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> md{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  check(context_->md != nullptr ? EVP_DigestInit_ex(context_->md.get(), EVP_sha256(), nullptr) : 0);
}

Sha256::~Sha256() = default;

Sha256& Sha256::add(std::span<const std::byte> bytes) {
  check(EVP_DigestUpdate(context_->md.get(), bytes.data(), bytes.size()));
  return *this;
}

std::string Sha256::finish() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  check(EVP_DigestFinal_ex(context_->md.get(), digest.data(), &size));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

std::string sha256_of(std::string_view text) {
  return Sha256().add(text).finish();
}

std::string sha256_of_file(const std::filesystem::path& file) {
  find_input(file);
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> bytes(1U << 20);
  Sha256 hash;
  while (stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || stream.gcount() > 0) {
    hash.add(std::string_view(bytes.data(), static_cast<size_t>(stream.gcount())));
  }
  if (!stream.eof())
    throw InputError({"file.read", "the file cannot be read to its end", file.string(), "check the disk"});
  return hash.finish();
}

}  // namespace promin::jobs
