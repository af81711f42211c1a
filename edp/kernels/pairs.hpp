// pairs.hpp: the gap between deformable bodies (9) and its conserving gap Jacobian: search for
// candidates, closest-point projection onto the facets of the counter-body (edges in the plane,
// faces in space; A is the dimension), rows of B and S, and the geometric contact stiffness at
// vertices. On a vertex, in space also an edge, n is along x - y, outwards by the mean normal of
// the facets that meet there. A candidate has the number counterBody np + point. Exports AnyPairs
// and make().
#pragma once
#include <memory>
#include <vector>
#include "arrays.hpp"
#include "facets.hpp"
#include "geometric.hpp"

namespace pairs {

using facets::Surface;

struct AnyPairs {
  virtual ~AnyPairs() {}
  virtual long search(const double *x, double searchDistance) = 0;
  virtual long start(const double *x, long unknowns) = 0;
  // For the increment d: penetrations q0, q1 [m] of the candidates of start() at both ends of the
  // step, and their rows of B and S. Where there can be no contact q0, q1 stay, and rows are zero.
  virtual void gaps(const double *d, double *q0, double *q1, JacobianRows &rows) = 0;
  virtual long near() const = 0;           // number of these candidates
  virtual void appendNear(std::vector<int> &numbers) const = 0;   // appends their numbers
  // Geometric contact stiffness at vertices in the plane for the normal forces t of the
  // candidates, at most `limit`; free (unknowns): 0 if held.
  virtual void geometricTerms(const double *t, const double *free, const double *limit,
                              Geometric &terms) = 0;
};

// The pairs in the plane or in space.
std::unique_ptr<AnyPairs> make(const Surface &surface);

}
