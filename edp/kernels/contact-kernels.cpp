// contact-kernels.cpp: registers the kernels of contact: gaps, rows, obstacles, and what goes in
// between contact points and beside them.
#include "scene.hpp"
#include "turning.hpp"

template<class Function> static void fillWhere(Ints at, long n, Function holds) {
  std::vector<long> found;
  for (long i = 0; i < n; i++) if (holds(i)) found.push_back(i);
  at.resize(long(found.size()));
  std::copy(found.begin(), found.end(), (long *)at);
}

static void addGaps() {
  // Kernels of gaps.hpp and pairs.hpp. The first three are called at the start.
  add("kernelGaps", +[](bool fixed, long gapRows, double staticReach, Reals nodalPosition, Reals u,
                       Reals q0, Reals frameMotion, Reals rest, Reals rates) {
    gaps.fixed = fixed;
    gaps.gapRows = int(gapRows);
    gaps.staticReach = staticReach;
    gaps.nodalPosition = Kept<double>{&nodalPosition}.numbers();
    gaps.u = {&u};  gaps.q0 = {&q0};  gaps.frameMotion = {&frameMotion};
    gaps.rest = {&rest};  gaps.rates = {&rates};
    gaps.makeFixed();
  });
  add("kernelSpread", +[](Sparse spread) { gaps.spread = byRows(spread); });
  add("kernelSurface", +[](Table shape, long points, long obstacles, long bodies, Ints unknown,
                          Ints body, Reals side, Reals pointShape, Ints selfContact,
                          Reals reference, Ints deformable, bool meet) {
    // meet: bodies may come into contact with each other or themselves
    const int facets = int(body.N()), nodes = int(shape.N());
    surface = {facets, nodes, int(points), facets * int(points), int(obstacles),
      int(bodies), copied<int>(unknown), copied<int>(body), copied<double>(side),
      copied<double>(pointShape), copied<int>(selfContact), copied<double>(reference),
      copied<int>(deformable), facets::ShapeCoefficients(nodes, shape.M())};
    for (int a = 0; a < nodes; a++) for (int j = 0; j < shape.M(); j++)
      surface.shape(a, j) = shape(a, j);
    if (meet) gaps.pairs = pairs::make(surface);
  });
  add("kernelGapsNow", +[](Reals u, double t, double distance, Reals q) {
    Kept<double>{&q}.numbers() = gaps.ofAll(gaps.now(Kept<double>{&u}.numbers(), t, distance),
                                            1, -tensors::infinity);
  });
  add("kernelGapMotion", +[](Reals w, double share, Reals moved) {
    // B w, and a share of the motion of the obstacles in the step
    Eigen::VectorXd ofNear = gaps.move(Kept<double>{&w}.numbers());
    ofNear += share * gaps.motion.head(ofNear.size());
    Kept<double>{&moved}.numbers() = gaps.ofAll(ofNear, gaps.gapRows, 0);
  });
  // positions of candidates that penetrate at the start or end of the step; of numbers other than 0
  add("kernelTouching", +[](Reals q0, Reals q1, Ints at) {
    fillWhere(at, q0.N(), [&](long i) { return q0[i] > 0 || q1[i] > 0; });
  });
  add("kernelNonzero", +[](Reals values, Ints at) {
    fillWhere(at, values.N(), [&](long i) { return values[i] != 0; });
  });
  add("kernelSlipSizes", +[](Reals gapSlip, Reals size) {
    // |slip| of all candidates [m], or |velocity| [m/s] if gapSlip contains velocities
    const long n = size.N();
    for (long i = 0; i < n; i++)
      size[i] = gapSlip.N() == 2 * n ? std::abs(gapSlip[n + i])
        : std::hypot(gapSlip[n + i], gapSlip[2 * n + i]);
  });
  add("kernelGapIncrement", +[](Reals d, double dt) {
    return gaps.increment(Kept<double>{&d}.numbers(), dt);
  });
  add("kernelMovesTooFar", +[](Reals d) {
    return long(gaps.movesTooFar(stepNow, Kept<double>{&d}.numbers()));
  });
  add("kernelObstacleWork", +[]() { return touching.obstacleWork(); });
  add("kernelCrossed", +[](Ints crossed) {   // points that passed through each obstacle
    gaps.obstacles.crossed.resize(crossed.N());
    std::copy(gaps.obstacles.crossed.begin(), gaps.obstacles.crossed.end(), (long *)crossed);
  });
}

static void fillRows(const JacobianRows &rows, Ints row, Ints unknown, Reals normal, Reals slip) {
  const long n = long(rows.row.size());
  row.resize(n);  unknown.resize(n);
  for (long e = 0; e < n; e++) { row[e] = rows.row[e];  unknown[e] = rows.unknown[e]; }
  fill(normal, rows.normal);
  fill(slip, rows.slip);
}

static void addRows() {
  // For verification: the search of a step, and the rows of pairs and obstacles as triplets.
  add("kernelSearchPairs", +[](Reals x, double searchDistance) {
    return gaps.pairs->search(x, searchDistance);
  });
  add("kernelPairStart", +[](Reals x) { return gaps.pairs->start(x, x.N()); });
  add("kernelPairGaps", +[](Reals d, Reals q0, Reals q1, Ints row, Ints unknown, Reals normal,
                           Reals slip) {
    JacobianRows rows;
    std::vector<int> numbers;
    gaps.pairs->appendNear(numbers);
    Eigen::VectorXd start = Kept<double>{&q0}.numbers()(numbers),
      end = Kept<double>{&q1}.numbers()(numbers);
    gaps.pairs->gaps(d, start.data(), end.data(), rows);
    Kept<double>{&q0}.numbers()(numbers) = start;
    Kept<double>{&q1}.numbers()(numbers) = end;
    fillRows(rows, row, unknown, normal, slip);
  });
  add("kernelSearch", +[](Reals d) { gaps.search(stepNow, Kept<double>{&d}.numbers()); });
  add("kernelObstacleStart", +[](Reals u0, double t, double searchDistance) {
    return gaps.obstacles.start(u0, t, searchDistance);
  });
  add("kernelObstacleRows", +[](Reals d, double dt, Reals q0, Reals q1, Reals motion, Ints row,
                               Ints unknown, Reals normal, Reals slip) {
    JacobianRows rows;
    std::vector<int> numbers;
    gaps.obstacles.appendNear(numbers);
    const long n = long(numbers.size()), ns = q0.N(), axes = gaps.obstacles.axes;
    Eigen::VectorXd start(n), end(n), moved(axes * n);
    gaps.obstacles.rows(d, dt, start, end, moved, rows);
    std::fill_n((double *)q0, gaps.obstacles.candidates(), -tensors::infinity);
    std::fill_n((double *)q1, gaps.obstacles.candidates(), -tensors::infinity);
    std::fill_n((double *)motion, motion.N(), 0.);
    for (long k = 0; k < n; k++) {
      q0[numbers[k]] = start[k];
      q1[numbers[k]] = end[k];
      for (long c = 0; c < axes; c++) motion[c * ns + numbers[k]] = moved[c * n + k];
    }
    fillRows(rows, row, unknown, normal, slip);
  });
}

static obstacles::Point spatial(Reals x) {           // with z = 0 in the plane
  return shapes::pointOf(x, int(x.N()));
}

static void addObstacles() {
  // Kernels of obstacles.hpp. The first four are called at the start.
  add("kernelObstacle", +[](std::string &kind, long axes, Reals numbers, Reals velocity) {
    // Appends an obstacle.
    obstacles::Obstacle added;
    added.shape = shapes::make(long(gaps.obstacles.obstacle.size()), kind, int(axes), numbers,
                               numbers.N());
    added.velocity = spatial(velocity);
    gaps.obstacles.obstacle.push_back(std::move(added));
  });
  add("kernelDrive", +[](long k, Reals pivot, Reals axis, Ints f) {
    // f: functions of the displacement (3) and of the angle
    obstacles::Obstacle &driven = gaps.obstacles.obstacle[k];
    driven.driven = true;
    driven.pivot = spatial(pivot);
    driven.axis = spatial(axis);
    for (int c = 0; c < 3; c++) driven.displacement[c] = functionOf(f[c]);
    driven.angle = functionOf(f[3]);
  });
  add("kernelContactPoints", +[](long axes, Reals places, Sparse traces) {
    gaps.obstacles.axes = int(axes);
    gaps.obstacles.setPoints(places, entries(traces));
  });
  add("kernelObstacleGaps", +[](long k, Reals x, double t, Reals gap, Reals normal) {
    // Gaps (m) [m] and normals (axes m) of obstacle k at time t, for m positions x (axes m).
    const obstacles::Pose pose = gaps.obstacles.obstacle[k].pose(t);
    const long m = gap.N(), axes = gaps.obstacles.axes;
    for (long i = 0; i < m; i++) {
      obstacles::Point place = obstacles::Point::Zero();
      for (long c = 0; c < axes; c++) place[c] = x[c * m + i];
      const shapes::Nearest closest = gaps.obstacles.obstacle[k].shape->nearest(pose.frame(place));
      const obstacles::Point n = pose.R * closest.normal;
      gap[i] = closest.gap;
      for (long c = 0; c < axes; c++) normal[c * m + i] = n[c];
    }
  });
  add("kernelTurn", +[](Table J, double t, Reals spin, Table R) {   // of turning.hpp
    turning::Vector w(spin[0], spin[1], spin[2]);
    turning::Matrix turned = Eigen::Map<turning::Matrix>(&R(0, 0));
    const long tumbles = turning::turnFreely(Eigen::Map<turning::Matrix>(&J(0, 0)), t, w, turned);
    for (int c = 0; c < 3; c++) spin[c] = w[c];
    Eigen::Map<turning::Matrix>(&R(0, 0)) = turned;
    return tumbles;
  });
  add("kernelObstaclePoint", +[](long k, double t, Reals X, Reals x) {
    // Position x (3) in the scene at time t of the point X of the frame of obstacle k.
    const obstacles::Point place = gaps.obstacles.obstacle[k].pose(t).scene(spatial(X));
    for (int c = 0; c < 3; c++) x[c] = place[c];
  });
  add("kernelObstacleVelocity", +[](long k, double t, Reals x, Reals v, Reals spin) {
    // Velocity v (3) of obstacle k at the position x in the scene, and its spin (3), at time t.
    const obstacles::Obstacle &moving = gaps.obstacles.obstacle[k];
    const obstacles::Point velocity = moving.velocityAt(t, spatial(x)), turning = moving.spin(t);
    for (int c = 0; c < 3; c++) { v[c] = velocity[c];  spin[c] = turning[c]; }
  });
}

static void addOutline() {
  // Kernels of facets.hpp, depths.hpp and outline.hpp. The first four are called at the start.
  add("kernelPieces", +[](Ints from, Ints to, Ints piece, Ints hasCorner, IntTable ridge) {
    const facets::Pieces pieces =
      facets::piecesOf(surface, copied<int>(from), copied<int>(to));
    std::copy(pieces.piece.begin(), pieces.piece.end(), (long *)piece);
    std::copy(pieces.hasCorner.begin(), pieces.hasCorner.end(), (long *)hasCorner);
    for (size_t k = 0; k < pieces.ridge.size(); k++) {
      ridge(0L, long(k)) = pieces.ridge[k].first;
      ridge(1L, long(k)) = pieces.ridge[k].second;
    }
  });
  add("kernelRidges", +[](Ints from, Ints to) {
    between.make(copied<int>(from), copied<int>(to), surface.reference.data());
  });
  add("kernelOutline", +[](Table places, Ints nodeBody, Ints selfContact, Reals radius,
                          double leastMotion, bool mirroredX, bool mirroredZ) {
    outlines.reference = Eigen::Map<outline::Places>(&places(0, 0), places.N(), 3);
    outlines.nodeBody = copied<int>(nodeBody);
    outlines.selfContact = copied<int>(selfContact);
    outlines.radius = copied<double>(radius);
    outlines.leastMotion = leastMotion;
    outlines.mirrored = {mirroredX, false, mirroredZ};
  });
  add("kernelOutlineSide", +[](Ints node, long axes, long kind, long turned) {
    outlines.add(copied<int>(node), int(axes), outline::Kind(kind), int(turned));
  });
  add("kernelOutlineChanges", +[](double motion, bool holds) {
    return long(outlines.mayChange(motion, holds));
  });
  add("kernelWatchOutline", +[](Table places, double t, double penetration, Ints heldNode,
                               Ints support, bool seeksOverlap) {
    outlines.watch(Eigen::Map<outline::Places>(&places(0, 0), places.N(), 3), t, penetration,
                   copied<int>(heldNode), copied<int>(support), gaps.obstacles, seeksOverlap);
  });
  add("kernelDepth", +[](Reals x, double t) { return between.measure(x, t); });
  add("kernelMayCross", +[](Reals d, double dt) {
    return long(between.mayCross(gaps.obstacles.largestIncrement(d, dt)));
  });
  add("kernelDepthOf", +[](long body, long counterBody, Reals numbers) {
    const depths::Depths::Pair &of = between.of(int(body), int(counterBody));
    fill(numbers, {of.deepest, of.radius, of.length, of.blunt});
  });
  add("kernelOutlineSeen", +[](long k, Reals seen) {
    // Value, time, place, and what it belongs to, of the overlap (0), a sunk or a held part.
    const outline::Seen &of = k == 0 ? outlines.overlap : k == 1 ? outlines.sunk : outlines.held;
    const auto X = outlines.reference.row(of.node);
    fill(seen, {of.value, of.time, X[0], X[1], X[2], double(of.first), double(of.second)});
  });
}

void addContact() {
  addGaps();
  addRows();
  addObstacles();
  addOutline();
}
