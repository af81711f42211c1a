// outline.cpp: the outline of outline.hpp.
#include <eigen3/unsupported/Eigen/BVH>
#include <numeric>
#include "outline.hpp"

namespace outline {

// Depths count above these shares of the bounding radius of a body.
const double sunkShare = 0.01, heldShare = 1e-3;

void Outline::add(const Indices &node, int axes, Kind kind, int turned) {
  kindOf.resize(reference.rows(), -1);
  touches.resize(reference.rows());
  for (int i : node) kindOf[i] = std::max(kindOf[i], kind == bare ? int(bare) : int(contact));
  if (kind == symmetry) return;
  if (kind == contact) for (int j = 0; j < axes; j++) touches[node[j]] = 1;
  const int body = nodeBody[node[0]];
  if (axes == 3) side.push_back({{node[0], node[1], node[2]}, body, turned});
  else if (node.size() == 2) side.push_back({node, body, turned});
  else for (int j = 0; j < 2; j++)
    side.push_back({{node[j == 0 ? 0 : 2], node[j == 0 ? 2 : 1]}, body, turned});
}

bool Outline::mayChange(double motion, bool holds) {
  movedSince += motion;
  const bool sinks = std::find(kindOf.begin(), kindOf.end(), bare) != kindOf.end();
  return sinks || holds || movedSince > leastMotion;
}

void Outline::watch(const Places &place, double t, double penetration, const Indices &heldNode,
                    const Indices &support, const obstacles::Obstacles &obstacles,
                    bool seeksOverlap) {
  if (seeksOverlap || movedSince > leastMotion) {
    movedSince = 0;
    if (overlap.time < 0) seekOverlap(place, t);
  }
  for (size_t k = 0; k < heldNode.size(); k++)
    watchDepth(held, heldNode[k], support[k], place, t,
               heldShare * radius[nodeBody[heldNode[k]]], obstacles);
  // Bare parts beside a contact face penetrate as far as that face.
  for (size_t i = 0; i < kindOf.size(); i++) if (kindOf[i] == bare)
    watchDepth(sunk, int(i), nodeBody[i], place, t,
               std::max(sunkShare * radius[nodeBody[i]], 2 * penetration), obstacles);
}

void Outline::watchDepth(Seen &seen, int node, int first, const Places &place, double t,
                         double least, const obstacles::Obstacles &obstacles) {
  for (size_t k = 0; k < obstacles.obstacle.size(); k++) {
    const obstacles::Obstacle &o = obstacles.obstacle[k];
    const double depth = -o.shape->nearest(o.pose(t).frame(place.row(node).transpose())).gap;
    if (depth > std::max(least, seen.value)) seen = {depth, t, node, first, int(k)};
  }
}

bool Outline::areWatched(const Side &a, const Side &b) const {
  // Whether two sides share no node, and no contact acts between them: they belong to one body
  // without self-contact, or one of them is neither a side of contact nor beside one.
  for (int i : a.node) for (int j : b.node) if (i == j) return false;
  const auto isBare = [&](const Side &side) {
    return std::none_of(side.node.begin(), side.node.end(), [&](int i) { return touches[i]; });
  };
  return isBare(a) || isBare(b) || (a.body == b.body && selfContact[a.body] == 0);
}

static double volume(const Point &p, const Point &q, const Point &r, const Point &s) {
  return (q - p).dot((r - p).cross(s - p));
}
static double turn(const Point &p, const Point &q, const Point &r) {   // in the plane
  return (q - p).cross(r - p)[2];
}

static bool passes(const Point &from, const Point &to, const Point *face) {
  // Whether the line from one point to another passes through a face.
  if (!(volume(face[0], face[1], face[2], from) * volume(face[0], face[1], face[2], to) < 0))
    return false;
  const double first = volume(from, to, face[0], face[1]),
    second = volume(from, to, face[1], face[2]), third = volume(from, to, face[2], face[0]);
  return first * second > 0 && first * third > 0;
}

bool Outline::cross(const Side &a, const Side &b, const Places &place) const {
  Point p[3], q[3];
  for (size_t j = 0; j < a.node.size(); j++) {
    p[j] = place.row(a.node[j]).transpose();
    q[j] = place.row(b.node[j]).transpose();
  }
  if (a.node.size() == 2)   // the ends of each side lie on both sides of the other
    return turn(p[0], p[1], q[0]) * turn(p[0], p[1], q[1]) < 0
      && turn(q[0], q[1], p[0]) * turn(q[0], q[1], p[1]) < 0;
  // Faces that pass through each other face each other, which neighbours do not.
  const Point n = a.turned * (p[1] - p[0]).cross(p[2] - p[0]),
    m = b.turned * (q[1] - q[0]).cross(q[2] - q[0]);
  if (n.dot(m) >= 0) return false;
  for (int j = 0; j < 3; j++)
    if (passes(p[j], p[(j + 1) % 3], q) || passes(q[j], q[(j + 1) % 3], p)) return true;
  return false;
}

// Finds the first box that meets another one and passes a test.
template <class Test> struct Search {
  const Eigen::AlignedBox3d &box;
  const std::vector<Eigen::AlignedBox3d> &boxes;
  Test test;
  int found;
  bool intersectVolume(const Eigen::AlignedBox3d &volume) { return volume.intersects(box); }
  bool intersectObject(int j) {
    if (boxes[j].intersects(box) && test(j)) found = j;
    return found >= 0;
  }
};

void Outline::seekOverlap(const Places &place, double t) {
  std::vector<Eigen::AlignedBox3d> boxes(side.size());
  Indices all(side.size());
  std::iota(all.begin(), all.end(), 0);
  for (int i : all) for (int n : side[i].node) boxes[i].extend(place.row(n).transpose());
  const Eigen::KdBVH<double, 3, int> tree(all.begin(), all.end(), boxes.begin(), boxes.end());
  const double beyond = -1e-9 * *std::max_element(radius.begin(), radius.end());
  for (int i : all) {
    const int node = side[i].node[0];
    for (int c = 0; c < 3; c++) for (int n : side[i].node)
      if (mirrored[c] && place(n, c) < beyond) overlap = {1, t, n, side[i].body, -1};
    const auto test = [&](int j) {
      return j > i && areWatched(side[i], side[j]) && cross(side[i], side[j], place);
    };
    Search<decltype(test)> search = {boxes[i], boxes, test, -1};
    Eigen::BVIntersect(tree, search);
    if (search.found >= 0) overlap = {1, t, node, side[i].body, side[search.found].body};
    if (overlap.time >= 0) return;
  }
}

void Outline::archive(Archive &archive) {
  archive(movedSince);
  for (Seen *seen : {&overlap, &sunk, &held}) {
    archive(seen->value);  archive(seen->time);
    archive(seen->node);  archive(seen->first);  archive(seen->second);
  }
}

}
