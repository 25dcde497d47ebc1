// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "core/divide_up.h"

namespace promin::work {
namespace {

/// Finds the note of the object file that contains an address.
struct Search {
  uintptr_t address = 0;
  std::string id;
};

/// Returns the build id in the notes of a segment; empty if there is none.
std::string find_note(std::span<const unsigned char> notes, size_t alignment) {
  constexpr std::string_view kOwner("GNU", 4);
  for (size_t at = 0; at + sizeof(ElfW(Nhdr)) <= notes.size();) {
    ElfW(Nhdr) head;
    std::memcpy(&head, &notes[at], sizeof(head));
    const size_t name = at + sizeof(head);
    const size_t content = next_multiple(name + head.n_namesz, alignment);
    const size_t end = content + head.n_descsz;
    if (end > notes.size()) return "";
    const std::string_view owner(reinterpret_cast<const char*>(&notes[name]), head.n_namesz);
    if (head.n_type == NT_GNU_BUILD_ID && owner == kOwner) {
      std::string digits;
      for (const unsigned char byte : notes.subspan(content, head.n_descsz)) digits += fmt::format("{:02x}", byte);
      return digits;
    }
    at = next_multiple(end, alignment);
  }
  return "";
}

int look_at(dl_phdr_info* object, size_t /*size*/, void* data) {
  Search& search = *static_cast<Search*>(data);
  const std::span segments(object->dlpi_phdr, object->dlpi_phnum);
  const bool is_there = std::ranges::any_of(segments, [&](const ElfW(Phdr) & segment) {
    const uintptr_t begin = object->dlpi_addr + segment.p_vaddr;
    return segment.p_type == PT_LOAD && search.address >= begin && search.address - begin < segment.p_memsz;
  });
  if (!is_there) return 0;
  for (const ElfW(Phdr) & segment : segments) {
    if (segment.p_type != PT_NOTE || !search.id.empty()) continue;
    const auto* notes = reinterpret_cast<const unsigned char*>(object->dlpi_addr + segment.p_vaddr);
    search.id = find_note({notes, segment.p_memsz}, std::max<size_t>(segment.p_align, 4));
  }
  return 1;
}

}  // namespace

const std::string& build_id() {
  static const std::string id = [] {
    Search search{reinterpret_cast<uintptr_t>(&look_at), {}};
    dl_iterate_phdr(look_at, &search);
    return search.id;
  }();
  return id;
}

}  // namespace promin::work
