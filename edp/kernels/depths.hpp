// depths.hpp: how deep obstacles and bodies go into each other between their contact points: convex
// corners of obstacles into bodies, and sharp corners and edges (ridges) of one of several bodies
// into the others and into obstacles. The depth of a corner is its radius minus the distance of its
// centre from the surface (negative inside). Exports Depths.
#pragma once
#include "facets.hpp"
#include "obstacles.hpp"

namespace depths {

typedef Eigen::Vector3d Point;             // z = 0 in the plane

class Depths {
 public:
  // Of two bodies, or a body and an obstacle (counterBody -1 - obstacle): largest depth [m]. Of the
  // obstacle's corner that went in where its radius [m] is smallest for a facet: this radius, the
  // length of the facet [m], and their ratio; 0: none.
  struct Pair {
    int body, counterBody;
    double deepest = 0, radius = 0, length = 0, blunt = 0;
  };

  Depths(const facets::Surface &all, const obstacles::Obstacles &rigid)
    : surface(all), obstacles(rigid) {}

  // Called once. ridges: node (j facets + c of corner j of facet c) at both ends of each ridge;
  // x: nodal positions in the reference.
  void make(const std::vector<int> &from, const std::vector<int> &to, const double *x);
  // Measures the state with the nodal positions x at the time t. Returns its largest depth [m].
  double measure(const double *x, double t);
  // Whether points that move by up to `motion` [m] may cross a convex corner unseen: farther than
  // to it and half through it.
  bool mayCross(double motion) const;
  const Pair &of(int body, int counterBody) { return pair(body, counterBody); }
  void archive(Archive &archive);

 private:
  const facets::Surface &surface;
  const obstacles::Obstacles &obstacles;
  struct Corner { int obstacle;  Point centre;  double radius; };
  struct Ridge { int body;  int from, fromNode, to, toNode; };   // facets, and their corners there
  std::vector<Corner> corner;
  std::vector<Ridge> ridge;
  std::vector<Pair> pairs;
  double gap = tensors::infinity, grain = 0;   // to the nearest corner now; size of a corner [m]
  double largest = 0;
  // of the facets in the present state: mean of the corners, longest side
  std::vector<Point> middle;
  std::vector<double> across;
  double margin = 0;                       // the largest of these
  std::vector<Eigen::AlignedBox3d> box;    // of the middles, by bodies

  // What is nearest to a point on the surface of a body: its distance [m], negative inside, and
  // facet; -1: none is near.
  struct Nearest { double distance;  int facet; };

  Pair &pair(int body, int counterBody);
  template<int A> void measureFacets(const double *x);
  template<int A> Nearest nearest(const double *x, int body, const Point &at) const;
  template<int A> void measureState(const double *x, double t);
  template<int A> double measureCorner(const double *x, double t, const Corner &c, int body);
  template<int A> void measureRidge(const double *x, double t, const Ridge &on, double share);
  void take(int body, int counterBody, double depth);
};

}
