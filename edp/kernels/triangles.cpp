// triangles.cpp: obstacles given as closed triangle meshes: signed distance and outward normal.
// The closest point is searched for in a tree of bounding boxes. It lies in a face, on an edge or
// at a vertex. The sign is the side of the normal at that place: that of the face, the sum of the
// normals of both faces, or the sum weighted with the angles at the vertex (Baerentzen & Aanaes
// 2005, IEEE Trans. Vis. Comput. Graph. 11, 243).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>
#include "shapes.hpp"
#include <eigen3/unsupported/Eigen/BVH>

namespace shapes {

typedef Eigen::AlignedBox3d Box;

class Surface {
 public:
  double rounding = 0;                     // outward offset of the surface [m]
  std::vector<Point> vertex;
  std::vector<std::array<int, 3>> triangle;   // counter-clockwise from outside

  void finish() {
    // Computes the normals and the tree; call after vertices and triangles are set.
    faceNormal.resize(triangle.size());
    vertexNormal.assign(vertex.size(), Point::Zero());
    for (size_t t = 0; t < triangle.size(); t++) {
      const auto &v = triangle[t];
      const Point &first = vertex[v[0]];
      faceNormal[t] = (vertex[v[1]] - first).cross(vertex[v[2]] - first).normalized();
      for (int j = 0; j < 3; j++) {
        const Point a = vertex[v[(j + 1) % 3]] - vertex[v[j]],
          b = vertex[v[(j + 2) % 3]] - vertex[v[j]];
        const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
        vertexNormal[v[j]] += angle * faceNormal[t];
        edgeNormal.insert({edge(v[j], v[(j + 1) % 3]), Point::Zero()}).first->second +=
          faceNormal[t];
      }
    }
    std::vector<int> faces(triangle.size());
    std::vector<Box> boxes(triangle.size());
    std::iota(faces.begin(), faces.end(), 0);
    for (int t : faces) for (int v : triangle[t]) boxes[t].extend(vertex[v]);
    tree = Tree(faces.begin(), faces.end(), boxes.begin(), boxes.end());
  }

  double gap(const Point &p, Point &n) const {
    // Signed distance of p from the surface, negative inside [m]; n: its unit outward normal.
    Closest closest{*this, p};
    Eigen::BVMinimize(tree, closest);
    const Point away = p - closest.point;
    const double distance = away.norm(), side = away.dot(closest.normal) < 0 ? -1 : 1;
    n = closest.inFace || distance == 0 ? closest.normal.normalized()
      : Point(side / distance * away);
    return side * distance - rounding;
  }

 private:
  typedef Eigen::KdBVH<double, 3, int> Tree;
  std::vector<Point> faceNormal, vertexNormal;
  std::map<std::pair<int, int>, Point> edgeNormal;
  Tree tree;                               // of the boxes of the triangles

  static std::pair<int, int> edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  // The closest point of the surface to p among the triangles visited so far: its squared distance,
  // the normal there (of any length), and whether it lies inside a face. BVMinimize() visits the
  // tree of boxes, the nearest first.
  struct Closest {
    typedef double Scalar;
    const Surface &surface;
    const Point p;
    double best = 1e300;
    Point point = Point::Zero(), normal = Point::UnitZ();
    bool inFace = false;
    Closest(const Surface &its_surface, const Point &its_point)
      : surface(its_surface), p(its_point) {}

    double minimumOnVolume(const Box &box) const { return box.squaredExteriorDistance(p); }
    double minimumOnObject(int t) { project(t);  return best; }

    void take(const Point &q, const Point &n, bool face) {
      const double distance2 = (p - q).squaredNorm();
      if (distance2 < best) { best = distance2;  point = q;  normal = n;  inFace = face; }
    }
    void project(int t) {
      // Closest-point projection onto triangle t (Ericson 2005, Real-Time Collision Detection,
      // 5.1.5).
      const Surface &s = surface;
      const auto &v = s.triangle[t];
      const Point a = s.vertex[v[0]], b = s.vertex[v[1]], c = s.vertex[v[2]], ab = b - a,
        ac = c - a, ap = p - a, bp = p - b, cp = p - c;
      const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp),
        d5 = ab.dot(cp), d6 = ac.dot(cp);
      const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
      if (d1 <= 0 && d2 <= 0) return take(a, s.vertexNormal[v[0]], false);
      if (d3 >= 0 && d4 <= d3) return take(b, s.vertexNormal[v[1]], false);
      if (d6 >= 0 && d5 <= d6) return take(c, s.vertexNormal[v[2]], false);
      if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return take(a + d1 / (d1 - d3) * ab, s.edgeNormal.at(edge(v[0], v[1])), false);
      if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return take(a + d2 / (d2 - d6) * ac, s.edgeNormal.at(edge(v[0], v[2])), false);
      if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return take(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b),
                    s.edgeNormal.at(edge(v[1], v[2])), false);
      const double sum = va + vb + vc;
      take(a + vb / sum * ab + vc / sum * ac, s.faceNormal[t], true);
    }
  };
};

// A closed triangle mesh in space.
class Triangles : public Shape {
 public:
  explicit Triangles(const double *numbers) {
    // numbers: rounding, number of vertices, number of triangles, x y z of each vertex, the three
    // vertices of each triangle.
    const long points = long(numbers[1]), faces = long(numbers[2]);
    mesh.rounding = numbers[0];
    for (long i = 0; i < points; i++)
      mesh.vertex.emplace_back(numbers[3 + 3 * i], numbers[4 + 3 * i], numbers[5 + 3 * i]);
    for (long i = 0, at = 3 + 3 * points; i < faces; i++, at += 3)
      mesh.triangle.push_back({int(numbers[at]), int(numbers[at + 1]), int(numbers[at + 2])});
    mesh.finish();
  }
  Nearest nearest(const Point &x) const override {
    Nearest closest = {0, Point::Zero(), 0};
    closest.gap = mesh.gap(x, closest.normal);
    return closest;
  }

 private:
  Surface mesh;
};

std::unique_ptr<Shape> triangles(const double *numbers) {
  return std::make_unique<Triangles>(numbers);
}

}
