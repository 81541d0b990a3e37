// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>

#include "solver/linalg/block_solver.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "tests/linalg/random_systems.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define ESFEM_WITH_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ESFEM_WITH_ADDRESS_SANITIZER
#endif
#endif

// Counts what is allocated: every call of malloc, operator new's and Eigen's included, comes by here.
// AddressSanitizer has a malloc of its own, and hooks for it; other C libraries have neither.
static std::atomic<int> allocations = 0;
#if defined(ESFEM_WITH_ADDRESS_SANITIZER)
#define ESFEM_COUNTS_ALLOCATIONS
// Declared here: GCC brings the function, but not its header <sanitizer/allocator_interface.h>.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));
[[maybe_unused]] static const int hooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++allocations; }, [](const volatile void*) {});
#elif defined(__GLIBC__)
#define ESFEM_COUNTS_ALLOCATIONS
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

#ifdef ESFEM_COUNTS_ALLOCATIONS
namespace esfem::test_no_allocation {
namespace {

/// How often work() allocates memory when it is called for the second time.
template <class Work>
int allocations_of_second_call(const Work& work) {
  work();
  const int before = allocations;
  work();
  return allocations - before;
}

class NoAllocation : public testing::Test {
 protected:
  std::shared_ptr<const SparsityPattern> pattern =
      std::make_shared<const SparsityPattern>(graph_pattern(2500, grid_edges(50)));
};

/// The matrix with `diagonal` on the diagonal and -1 off it.
SymmetricMatrix laplacian(const std::shared_ptr<const SparsityPattern>& pattern, double diagonal) {
  SymmetricMatrix A{pattern, Eigen::VectorXd::Constant(pattern->entry_count(), -1)};
  for (int j = 0; j < pattern->size; ++j) A.values[pattern->column_start[j]] = diagonal;
  return A;
}

TEST_F(NoAllocation, TheCounterSeesThoseOfEigenAndOfNew) {
  EXPECT_GE(allocations_of_second_call([] { Eigen::VectorXd(1000).setRandom(); }), 1);
  EXPECT_GE(allocations_of_second_call([] { std::vector<double>(1000).at(999) = 1; }), 1);
}

TEST_F(NoAllocation, InFactorisationsAndSolvesFromTheSecondCallOn) {
  const SymmetricMatrix M = laplacian(pattern, 8), A = laplacian(pattern, 5);
  const Field right = Field::Ones(pattern->size, 4);
  Field u = right, w = right;

  SpdSolver spd(pattern);
  EXPECT_EQ(allocations_of_second_call([&] {
              spd.factorise(2, M, 1, A);
              spd.solve(u);
              spd.round();
              spd.solve(u);
            }),
            0);
  BlockSolver block(pattern);
  EXPECT_EQ(allocations_of_second_call([&] {
              block.factorise(2, 1, 1, M, A);
              block.solve(u, w);
              block.refine(2.001, 1, 1, M, A, right, right, 9, u, w);
            }),
            0);
  const auto blocks = random_blocks<double, 4>(*pattern);
  SymmetricFactor<double, 4> factor(*pattern, {1, 1, 1, 1});
  SymmetricFactor<double, 4>::Right four = Eigen::MatrixXd::Ones(4 * pattern->size, 6);
  EXPECT_EQ(allocations_of_second_call([&] {
              factor.factorise(entries<double, 4>(blocks));
              factor.solve(four);
            }),
            0);
}

}  // namespace
}  // namespace esfem::test_no_allocation
#endif
