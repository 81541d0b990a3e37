// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/msh_elements.hpp"

#include <algorithm>

namespace esfem {

namespace {

std::vector<MshElementType> all_types() {
  return {
      {15, 0, 1, 0, "point"},
      {1, 1, 2, 0, "2-node line"},
      {8, 1, 3, 0, "3-node line"},
      {26, 1, 4, 0, "4-node line"},
      {27, 1, 5, 0, "5-node line"},
      {28, 1, 6, 0, "6-node line"},
      {62, 1, 7, 0, "7-node line"},
      {63, 1, 8, 0, "8-node line"},
      {64, 1, 9, 0, "9-node line"},
      {65, 1, 10, 0, "10-node line"},
      {66, 1, 11, 0, "11-node line"},
      {2, 2, 3, 1, "3-node triangle"},
      {9, 2, 6, 2, "6-node triangle"},
      {21, 2, 10, 3, "10-node triangle"},
      {23, 2, 15, 4, "15-node triangle"},
      {20, 2, 9, 0, "incomplete 9-node triangle"},
      {22, 2, 12, 0, "incomplete 12-node triangle"},
      {24, 2, 15, 0, "incomplete 15-node triangle of order 5"},
      {25, 2, 21, 0, "21-node triangle of order 5"},
      {3, 2, 4, 1, "4-node quadrangle"},
      {16, 2, 8, 0, "8-node quadrangle"},
      {10, 2, 9, 0, "9-node quadrangle"},
      {36, 2, 16, 0, "16-node quadrangle"},
      {37, 2, 25, 0, "25-node quadrangle"},
      {4, 3, 4, 1, "4-node tetrahedron", {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
      {11,
       3,
       10,
       2,
       "10-node tetrahedron",
       {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}}},
      {29, 3, 20, 0, "20-node tetrahedron"},
      {30, 3, 35, 0, "35-node tetrahedron"},
      {5,
       3,
       8,
       1,
       "8-node hexahedron",
       {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      {17, 3, 20, 0, "20-node hexahedron"},
      {12, 3, 27, 0, "27-node hexahedron"},
      {6, 3, 6, 1, "6-node prism", {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {18, 3, 15, 0, "15-node prism"},
      {13, 3, 18, 0, "18-node prism"},
      {7, 3, 5, 1, "5-node pyramid", {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
      {19, 3, 13, 0, "13-node pyramid"},
      {14, 3, 14, 0, "14-node pyramid"},
  };
}

}  // namespace

const MshElementType* msh_element_type(long number) {
  static const std::vector<MshElementType> types = all_types();
  const auto found = std::find_if(types.begin(), types.end(),
                                  [&](const MshElementType& type) { return type.number == number; });
  return found == types.end() ? nullptr : &*found;
}

}  // namespace esfem
