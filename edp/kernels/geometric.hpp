// geometric.hpp: geometric contact stiffness. B rotates with the increment, so that B^T t of the
// contact forces t changes by c T^T T delta. Exports Geometric.
#pragma once
#include <vector>

// The terms: their stiffness c, and the rows T as triplets T(term, unknown) = value.
struct Geometric {
  std::vector<int> term, unknown;
  std::vector<double> value, stiffness;
};
