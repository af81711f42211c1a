// kernels.cpp: the FreeFEM plugin that kernels.idp loads. It registers all kernels under their
// names in the scripts. A process computes one scene, so its bodies and the factorisation of their
// tangent are static objects.
#include <cholmod.h>   // first: without SuiteSparse's headers the build ends at once
#include "call.hpp"
#include "bodies.hpp"
#include "contact.hpp"
#include "depths.hpp"
#include "explicit.hpp"
#include "factor.hpp"
#include "input.hpp"
#include "loads.hpp"
#include "outline.hpp"
#include "step.hpp"
#include "turning.hpp"

static bodies::Elements elements;
static bodies::Bodies body(elements);
static bodies::Inertia inertia(elements);
static bodies::Loads loads;
static bodies::Supports supports(elements, body);
static Step stepNow;                                 // set by kernelIntegrator
static std::vector<TimeFunction> functions;
static std::vector<const laws::Law *> law;           // of the bodies
static Factor factor;
static contact::Gaps gaps;
static contact::Contact touching(gaps, factor, elements.ndof, elements.free);
static const Terms terms = {&body, &inertia, &loads, &touching, &supports};   // of (2)
static const Terms besideContact = {&body, &inertia, &loads, &supports};   // of explicit steps
static ImplicitStep step(elements, body, terms, factor, touching);
static ExplicitContact substep(touching);
static outline::Outline outlines;
static facets::Surface surface;
static depths::Depths between(surface, gaps.obstacles);   // contact points

static Triplets entries(Sparse A) {
  // The entries of a sparse matrix. The kernels take no half (symmetric) or 1-based storage.
  HashMatrix<int, double> *H = A.pHM();
  ffassert(H && !H->half && !H->fortran);
  return {H->n, H->m, H->nnz, H->i, H->j, H->aij};
}

static void fill(Reals array, const std::vector<double> &values) {
  array.resize(long(values.size()));
  std::copy(values.begin(), values.end(), static_cast<double *>(array));
}

static void addBodies() {
  // Kernels of bodies.hpp: materials, discretisation, forces, energy and stresses.
  add("kernelComponent", +[](long i, long dimensions, Sparse pick) {
    elements.component(int(i), int(dimensions), entries(pick));
  });
  add("kernelLawOf", +[](long body, std::string &name) {
    law.resize(std::max(law.size(), size_t(body + 1)));
    law[body] = laws::find(name);
  });
  add("kernelMaterial", +[](Reals lambda, Reals mu, Reals own, Reals eta, Reals zeta,
                           Reals relaxing, Reals relaxTime, Reals bulk, Ints bodyOfPoint,
                           Ints volumeByTrace, Ints incompressible, Reals weight) {
    // Arrays over the nq quadrature points; `own` has mostOwn stacked components.
    const long nq = weight.N();
    ffassert(own.N() == laws::mostOwn * nq);
    elements.weight = copied<double>(weight);
    for (long q = 0; q < nq; q++) {
      laws::Material m = {law[bodyOfPoint[q]], lambda[q], mu[q], {}, eta[q], zeta[q], relaxing[q],
                          relaxTime[q], bulk[q], volumeByTrace[q], incompressible[q]};
      for (int k = 0; k < laws::mostOwn; k++) m.own[k] = own[k * nq + q];
      elements.addPoint(m);
    }
  });
  add("kernelBodies", +[](Sparse gradient, Sparse mass, Reals free) {
    elements.free = copied<double>(free);
    elements.make(entries(gradient));
    inertia.setMass(entries(mass));
    factor.pattern(elements);
    body.make();
  });
  add("kernelMass", +[](Sparse mass) { inertia.setMass(entries(mass)); });
  // after a change of the unknowns that supports hold
  add("kernelFree", +[](Reals free) { elements.free = copied<double>(free); });
  add("kernelBegin", +[](Reals F, Reals v) {
    // A step begins at the deformation F with the velocity v, and without contact forces.
    body.start(F);
    touching.startFrom(Kept<double>{&v}.numbers());
  });
  add("kernelIntegrator", +[](double t, double dt, double massScale, double stiffnessScale,
                             long stressInstant, double staticShare, Reals inertiaKnown) {
    stepNow = {t, dt, massScale, stiffnessScale, int(stressInstant), staticShare, false};
    inertia.known = {&inertiaKnown};
  });
  add("kernelForces", +[](Reals d, bool contact, Reals residual) {
    Eigen::VectorXd sum;
    const long ended = sumForces(contact ? terms : besideContact, stepNow,
                                 Kept<double>{&d}.numbers(), sum);
    Kept<double>{&residual}.numbers() = sum;
    return ended;
  });
  add("kernelTerm", +[](std::string &name, Reals d, Reals forces, double &work) {
    // Forces and work of one term at d (for verification).
    Term *term = name == "inertia" ? (Term *)&inertia : name == "loads" ? (Term *)&loads
      : name == "contact" ? (Term *)&touching : &body;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(d.N());
    const Eigen::VectorXd increment = Kept<double>{&d}.numbers();
    const long ended = term->addForces(stepNow, increment, sum);
    Kept<double>{&forces}.numbers() = sum;
    work = term->work(stepNow, increment);
    return ended;
  });
  add("kernelAccept", +[](Reals d) {
    for (Term *term : terms) term->accept(stepNow, Kept<double>{&d}.numbers());
  });
  add("kernelRelax", +[]() { body.relax(); });
  // F, C, det F at the start of a step; det F at its end; pressures of the elements; energy
  // dissipated so far (nq) [J/m3]
  add("kernelDeformation", +[](Reals F, Reals C, Reals jacobian) {
    fill(F, body.F0);  fill(C, body.C0);  fill(jacobian, body.J0);
  });
  add("kernelEndJacobian", +[](Reals jacobian) { fill(jacobian, body.J1); });
  add("kernelPressures", +[](Reals p) {
    if (body.volume) fill(p, body.volume->start); else p.resize(0);
  });
  add("kernelMeans", +[](Reals values, Reals means) { elements.means(values, means); });
  add("kernelDissipated", +[](Reals W) { body.dissipated(W); });
  add("kernelStress", +[](Reals C, Reals S) { body.lawStresses(C, S); });
  add("kernelGradientCorrection", +[](Reals M, Reals H, Reals e) { body.corrections(M, H, e); });
  add("kernelEnergy", +[](Reals C, Reals W) { body.energies(C, W); });
  add("kernelSmallestStretch", +[](Reals C, Reals stretch) {
    body.smallestStretches(C, stretch);
  });
  add("kernelEllipticity", +[](Reals C, Reals e) { body.ellipticities(C, e); });
  add("kernelStresses", +[](Reals F, Reals p, Reals sigma, Reals mises) {
    body.stresses(F, p, sigma, mises);
  });
}

static const TimeFunction &functionOf(long f) {      // -1: the function 0
  static const TimeFunction none = {};
  return f < 0 ? none : functions[f];
}

static void addFunctions() {
  // Kernels of time-function.hpp: functions of time by their numbers.
  add("kernelFunctions", +[](Ints first, Reals time, Reals value, Reals slope, Reals soFar,
                            Table largest) {
    const auto part = [&](Reals of, long f) {
      return std::vector<double>((double *)of + first[f], (double *)of + first[f + 1]);
    };
    for (long f = 0; f < first.N() - 1; f++)
      functions.push_back({part(time, f), part(value, f), part(slope, f), part(soFar, f),
                           largest(0L, f)});
  });
  add("kernelFunctionRate", +[](long f, double t) { return functionOf(f).rate(t); });
  add("kernelBend", +[](double t, double dt, bool untilThen) {
    double most = 0;
    for (const TimeFunction &f : functions) most = std::max(most, f.bend(t, dt, untilThen));
    return most;
  });
  add("kernelMoveSupports", +[](Ints motion, double t, double dt, Reals increment, Reals speed) {
    // Increments of the unknowns from t to t + dt, and velocities at the end; motion (ndof): their
    // functions.
    for (long i = 0; i < motion.N(); i++) {
      const TimeFunction &f = functionOf(motion[i]);
      increment[i] = f.at(t + dt) - f.at(t);
      speed[i] = f.rate(t + dt);
    }
  });
}

static Eigen::SparseMatrix<double, Eigen::RowMajor> byRows(Sparse A) {
  const Triplets all = entries(A);
  std::vector<Eigen::Triplet<double>> list;
  for (size_t e = 0; e < all.size; e++) list.emplace_back(all.row[e], all.column[e], all.value[e]);
  Eigen::SparseMatrix<double, Eigen::RowMajor> B(all.n, all.m);
  B.setFromTriplets(list.begin(), list.end());
  return B;
}

static void addLoads() {
  // Kernels of loads.hpp. The first six are called at the start.
  add("kernelConditions", +[](Reals u, Reals bodyForce, Reals loadForce, Reals heldResidual,
                             Reals gasVolume, Table gas, Reals inflation) {
    loads.u = {&u};  loads.bodyForce = {&bodyForce};  loads.force = {&loadForce};
    loads.volume = {&gasVolume};  loads.gas = &gas;
    loads.inflation = {&inflation};
    supports.reaction = {&heldResidual};
  });
  add("kernelLoad", +[](long kind, bool ofRigidBody, Ints f) {   // appends a load
    loads.load.push_back({int(kind), ofRigidBody,
                          {functionOf(f[0]), functionOf(f[1]), functionOf(f[2])}});
  });
  add("kernelLoadShapes", +[](long c, Sparse place, Sparse alongR, Sparse alongS) {
    loads.place[c] = byRows(place);
    loads.alongR[c] = byRows(alongR);
    loads.alongS[c] = byRows(alongS);
  });
  add("kernelLoadPoints", +[](Reals position, Ints loadOfPoint, Reals weight, Table outward,
                             long axes, bool revolves, double symmetryFactor) {
    loads.position = {&position};
    loads.loadOf = copied<int>(loadOfPoint);
    loads.weight = Kept<double>{&weight}.numbers();
    loads.axes = int(axes);
    loads.revolves = revolves;
    loads.symmetryFactor = symmetryFactor;
    loads.outwards(&outward(0, 0));
    loads.unstressed = loads.volumes(loads.position.numbers());
  });
  add("kernelLoadedAreas", +[](Reals area) { Kept<double>{&area}.numbers() = loads.areas(); });
  add("kernelGasVolumes", +[](Reals x, Reals volume) {
    Kept<double>{&volume}.numbers() = loads.volumes(Kept<double>{&x}.numbers());
  });
  add("kernelLoads", +[](Reals d, double t, double dt, double staticShare) {
    // loadForce and gasVolume of a step by d
    Step at;
    at.t = t;
    at.dt = dt;
    at.staticShare = staticShare;
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(d.N());
    loads.addForces(at, Kept<double>{&d}.numbers(), residual);
  });
}

static void addFactor() {
  // Kernels of factor.hpp: the tangent A, its factorisation and its compliance.
  add("kernelTangentAtRest", +[](double massScale) {
    // massScale M + K of the undeformed bodies without damping
    Step rest;
    rest.massScale = massScale;
    rest.staticShare = 1;
    body.lineariseAtRest();
    sumTangents(terms, rest, elements.block);
    factor.numbers(elements);
  });
  add("kernelTangent", +[]() {             // at the last evaluation
    body.linearise(true);
    sumTangents(terms, stepNow, elements.block);
    factor.numbers(elements);
  });
  add("kernelTangentEntries", +[](Ints row, Ints column, Reals value) {
    // The entries of both triangles of A.
    const std::vector<Factor::Triplet> all = factor.entries();
    const long n = long(all.size());
    row.resize(n);  column.resize(n);  value.resize(n);
    for (long e = 0; e < n; e++) {
      row[e] = all[e].row;
      column[e] = all[e].column;
      value[e] = all[e].value;
    }
  });
}

static void archiveAll(Archive &archive) {
  step.archive(archive);
  outlines.archive(archive);
  between.archive(archive);
}

static void addStep() {
  // Kernels of contact.hpp, step.hpp and explicit.hpp. The first two are called once.
  add("kernelContactArrays", +[](Reals q1, Reals gapSlip, Reals candidateForces, Reals force,
                                Reals k, Reals muStatic, Reals muDynamic, Ints sticks) {
    touching.script = {{&q1}, {&gapSlip}, {&candidateForces}, {&force}, {&k}, {&muStatic},
                       {&muDynamic}, {&sticks}};
  });
  add("kernelStepArrays", +[](Reals d, Reals v, Reals frameMotion, Reals seconds, Ints counts,
                             Sparse translations) {
    step.script = {{&d}, {&v}, {&frameMotion}, {&seconds}, {&counts}};
    step.translations = entries(translations);
  });
  add("kernelSettings", +[](double tolerance, double correctionTolerance, double momentumShare,
                           double leastVolumeRatio, bool breaks, bool newMatrix,
                           bool allCandidates, long fallbackCost) {
    step.settings = {tolerance, correctionTolerance, momentumShare, newMatrix, allCandidates,
                     fallbackCost};
    body.breaks = breaks;
    body.leastVolumeRatio = leastVolumeRatio;
  });
  add("kernelStep", +[](double energyScale, double momentumScale, double roundOff,
                       long mostContactMatrices, double &residualWorkRatio) {
    touching.mostContactMatrices = mostContactMatrices;
    const long ended = step.take({stepNow, energyScale, momentumScale, roundOff});
    residualWorkRatio = step.residualWorkRatio;
    return ended;
  });
  add("kernelTractions", +[](Reals vN0, Reals gapSlip, Reals k, Reals muStatic, Reals muDynamic,
                            Ints sticks, double dt, long lawInstant, Reals t, Reals slope) {
    // Forces t on n points and their slopes by kernelLaw, for verification. vN0 (n): penetrations
    // at the start; gapSlip (m n): those at the end and the slips. slope: row i, column j at (3 i +
    // j) n.
    const long n = vN0.N(), m = gapSlip.N() / n;
    contact::Law law = touching.law;
    law.dt = dt;
    law.lawInstant = int(lawInstant);
    for (long i = 0; i < n; i++) {
      contact::Forces forces = {};
      double x[3] = {};
      for (long c = 0; c < m; c++) x[c] = gapSlip[c * n + i];
      law.at({vN0[i], k[i], muStatic[i], muDynamic[i], sticks[i] == 1}, x, nullptr, forces);
      for (long c = 0; c < m; c++) t[c * n + i] = forces.t[c];
      for (long c = 0; c < 9; c++) slope[c * n + i] = forces.slope[c / 3][c % 3];
    }
  });
  add("kernelForget", +[]() { step.forget(); });
  add("kernelState", +[](Reals state) {
    // Stores in an array what the step remembers from earlier steps.
    Archive archive;
    archiveAll(archive);
    state.resize(long(archive.numbers.size()));
    std::copy(archive.numbers.begin(), archive.numbers.end(), (double *)state);
  });
  add("kernelRestore", +[](Reals state) {
    Archive archive;
    archive.numbers = copied<double>(state);
    archive.reads = true;
    archiveAll(archive);
    if (step.isFactorised()) step.restore();
  });
  add("kernelSubsteps", +[](Reals d, Reals compliance, double distance) {
    substep.begin(stepNow, Kept<double>{&d}.numbers(), Kept<double>{&compliance}.numbers(),
                  distance);
  });
  add("kernelSubstep", +[](Reals x, double t, Reals increment, Reals halfStepVelocity, double h) {
    // A substep of length h from the displacements x at the time t.
    gaps.goOn(Kept<double>{&x}.numbers(), t, h);
    return long(substep.take(Kept<double>{&increment}.numbers(),
                             Kept<double>{&halfStepVelocity}.numbers(), h));
  });
  add("kernelDampingWork", +[]() { return touching.dampingWork(); });
  add("kernelLaw", +[](double exponent, double retardation, double slipVelocity, double bridge,
                      double sticksBelow, std::string &regularization, bool jumps, long slips,
                      long mostStatusChanges) {
    // Parameters of (10)-(13) that all contact points share; see Law and Problem.
    contact::Law &law = touching.law;
    law.exponent = exponent;
    law.retardation = retardation;
    law.slipVelocity = slipVelocity;
    law.bridge = bridge;
    law.regularization = regularization == "sqrt" ? contact::sqrtOf
      : regularization == "tanh" ? contact::tanhOf
      : regularization == "linear" ? contact::linear : contact::linearPrinted;
    law.jumps = jumps;
    law.slips = int(slips);
    touching.problem.sticksBelow = sticksBelow;
    touching.problem.mostStatusChanges = int(mostStatusChanges);
  });
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
    Kept<double>{&q}.numbers() = gaps.now(Kept<double>{&u}.numbers(), t, distance);
  });
  add("kernelGapMotion", +[](Reals w, double share, Reals moved) {
    // B w, and a share of the motion of the obstacles in the step
    Kept<double>{&moved}.numbers() = gaps.move(Kept<double>{&w}.numbers());
    Kept<double>{&moved}.numbers() += share * gaps.motion.head(moved.N());
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
    gaps.pairs->gaps(d, q0, q1, rows);
    fillRows(rows, row, unknown, normal, slip);
  });
  add("kernelSearch", +[](Reals d) { gaps.search(stepNow, Kept<double>{&d}.numbers()); });
  add("kernelObstacleStart", +[](Reals u0, double t, double searchDistance) {
    return gaps.obstacles.start(u0, t, searchDistance);
  });
  add("kernelObstacleRows", +[](Reals d, double dt, Reals q0, Reals q1, Reals motion, Ints row,
                               Ints unknown, Reals normal, Reals slip) {
    JacobianRows rows;
    Eigen::VectorXd start = Kept<double>{&q0}.numbers(), end = start,
      moved = Kept<double>{&motion}.numbers();
    gaps.obstacles.rows(d, dt, start, end, moved, rows);
    Kept<double>{&q0}.numbers() = start;
    Kept<double>{&q1}.numbers() = end;
    Kept<double>{&motion}.numbers() = moved;
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

extern "C" void openblas_set_num_threads(int) __attribute__((weak));

static void limitThreads() {
  // One thread for BLAS, unless the environment sets their number: waiting threads take as much
  // processor time as working ones.
  if (!getenv("OPENBLAS_NUM_THREADS") && !getenv("OMP_NUM_THREADS") && openblas_set_num_threads)
    openblas_set_num_threads(1);
}

static void addStatuses() {                   // status.hpp
  const auto name = [](const char *text, Status status) {
    Global.New(text, CConstant<long>(status));
  };
  name("succeeded", succeeded);
  name("diverged", diverged);
  name("inverted", inverted);
  name("notANumber", notANumber);
}

static void addKernels() {
  limitThreads();
  addStatuses();
  addInput();
  addBodies();
  addFunctions();
  addLoads();
  addFactor();
  addStep();
  addGaps();
  addRows();
  addObstacles();
  addOutline();
}

LOADFUNC(addKernels)
