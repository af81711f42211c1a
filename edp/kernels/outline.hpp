// outline.hpp: where bodies go that no contact force holds them back from: through each other or
// themselves, and with bare or held parts of their boundary into an obstacle. The boundary consists
// of straight sides, edges from node to node, in space triangles of the corners of boundary faces.
// Exports Outline.
#pragma once
#include <array>
#include "obstacles.hpp"

namespace outline {

typedef Eigen::Vector3d Point;             // z = 0 in the plane
typedef Eigen::Matrix<double, Eigen::Dynamic, 3> Places;
typedef std::vector<int> Indices;

// What may come into contact, what lies in a plane of symmetry, and the bare rest.
enum Kind { bare, contact, symmetry };

// An extreme: its value, time [s] (-1: none yet), node, and what it belongs to.
struct Seen {
  double value = 0, time = -1;
  int node = 0, first = 0, second = 0;
};

class Outline {
 public:
  // Set once. Reference places and body of every node; radii of the bodies [m]; 1: the body may
  // come into contact with itself; motion [m] of nodes from which overlaps are sought; whether a
  // plane or axis of symmetry bounds the bodies at x = 0, z = 0.
  Places reference;
  Indices nodeBody, selfContact;
  std::vector<double> radius;
  double leastMotion = 0;
  std::array<bool, 3> mirrored = {false, false, false};

  // First overlap, with the bodies (-1: the mirror image). Largest depth [m] in an obstacle of a
  // bare part, with body and obstacle, and of a held part, with support and obstacle.
  Seen overlap, sunk, held;

  // Adds a boundary element with these nodes, corners first. turned: 1 if the normal by its corners
  // is outward, else -1.
  void add(const Indices &node, int axes, Kind kind, int turned);
  // Whether the state must be watched after nodes have moved by up to `motion` [m].
  bool mayChange(double motion, bool holds);
  // Watches the state with the nodes at `place` at the time t [s]. penetration: largest one of
  // contact points [m]; heldNode, support: nodes that supports hold, and by which.
  void watch(const Places &place, double t, double penetration, const Indices &heldNode,
             const Indices &support, const obstacles::Obstacles &obstacles, bool seeksOverlap);
  void archive(Archive &archive);

 private:
  struct Side {
    Indices node;
    int body, turned;
  };
  std::vector<Side> side;
  Indices kindOf, touches;                 // of nodes; 1: a corner of a contact side
  double movedSince = 0;                   // by nodes since the last search for overlaps [m]

  bool areWatched(const Side &a, const Side &b) const;
  bool cross(const Side &a, const Side &b, const Places &place) const;
  void seekOverlap(const Places &place, double t);
  void watchDepth(Seen &seen, int node, int first, const Places &place, double t, double least,
                  const obstacles::Obstacles &obstacles);
};

}
