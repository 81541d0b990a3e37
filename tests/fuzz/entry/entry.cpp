// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of libFuzzer; ESFEM_FUZZ_TARGET is a name of fuzz_targets().
#include <cstddef>
#include <cstdint>

#include "solver/error.hpp"
#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto target = esfem::fuzz_targets().at(ESFEM_FUZZ_TARGET);
  try {
    target(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const esfem::InputError&) {
  } catch (const esfem::NumericsError&) {
  }
  return 0;
}
