// kernels.cpp: the FreeFEM plugin that kernels.idp loads. It registers all kernels under their
// names in the scripts, those of contact by contact-kernels.cpp.
#include "scene.hpp"
#include "explicit.hpp"
#include "factor.hpp"
#include "input.hpp"
#include "step.hpp"

struct OfMaterial {
  const laws::Law *law;
  std::vector<double> numbers;             // of the law
  laws::Dampers dampers;
  laws::Yield yield;                       // of a metal
};
static std::deque<OfMaterial> ofMaterial;  // by number
static Factor factor;
namespace scene {
bodies::Elements elements;
bodies::Bodies body(elements);
bodies::Inertia inertia(elements);
bodies::Loads loads;
bodies::Supports supports(elements, body, inertia);
Step stepNow;
std::vector<TimeFunction> functions;
contact::Gaps gaps;
contact::Contact touching(gaps, factor, elements.ndof, elements.free);
outline::Outline outlines;
facets::Surface surface;
depths::Depths between(surface, gaps.obstacles);
}
static const Terms terms = {&body, &inertia, &loads, &touching, &supports};   // of (2)
static const Terms besideContact = {&body, &inertia, &loads, &supports};   // of explicit steps
static ImplicitStep step(elements, body, terms, factor, touching);
static ExplicitContact substep(touching);

static laws::Branches branchesOf(Reals pairs) {
  laws::Branches all;
  for (long j = 0; j < pairs.N(); j += 2) all.push_back({pairs[j], pairs[j + 1]});
  return all;
}

static laws::Yield yieldOf(Reals numbers) {
  // H, Q, b, n, C, rate0, and alpha and stress of each point of the curve
  laws::Yield yield = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], {}};
  for (long j = 6; j < numbers.N(); j += 2) yield.curve.push_back({numbers[j], numbers[j + 1]});
  return yield;
}

static void addBodies() {
  // Kernels of bodies.hpp: materials, discretisation, forces of the terms.
  add("kernelComponent", +[](long i, long dimensions, Sparse pick) {
    elements.component(int(i), int(dimensions), entries(pick));
  });
  add("kernelLawOf", +[](long number, std::string &name, Reals numbers, Reals branches,
                         Reals bulkBranches) {
    // Of materials 0, 1 ... in this order; branches: modulus and time of each. Returns the largest
    // kappa [Pa].
    ffassert(number == long(ofMaterial.size()));
    const std::vector<double> own = copied<double>(numbers);
    ofMaterial.push_back({laws::find(name, own), own,
                          {branchesOf(branches), branchesOf(bulkBranches)},
                          name == "metal" ? yieldOf(numbers) : laws::Yield{}});
    ofMaterial.back().numbers.resize(own.size() + 8, 0.);   // 0: no further terms of ogden
    return ofMaterial.back().law->mostBulk();
  });
  add("kernelMaterial", +[](Reals lambda, Reals mu, Reals eta, Reals zeta, Reals bulk,
                           Ints materialOfPoint, Ints volumeByTrace, Ints incompressible,
                           Reals weight) {
    // Arrays over the nq quadrature points.
    const long nq = weight.N();
    elements.weight = copied<double>(weight);
    for (long q = 0; q < nq; q++) {
      const OfMaterial &of = ofMaterial[materialOfPoint[q]];
      elements.addPoint({of.law, lambda[q], mu[q], of.numbers.data(), eta[q], zeta[q], &of.dampers,
                         of.yield.curve.empty() ? nullptr : &of.yield, bulk[q], volumeByTrace[q],
                         incompressible[q]});
    }
  });
  add("kernelNuAtPoints", +[]() {         // the largest of what acts at points
    double most = 0;
    for (const laws::Material &m : elements.materials)
      most = std::max(most, m.lambda / (2 * (m.lambda + m.mu)));
    return most;
  });
  add("kernelBodies", +[](Sparse shapes, Sparse mass, Reals free) {
    elements.free = copied<double>(free);
    elements.make(entries(shapes));
    inertia.setMass(entries(mass));
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
  add("kernelAcceptBodies", +[](Reals d) { body.accept(stepNow, Kept<double>{&d}.numbers()); });
  add("kernelRelax", +[]() { body.relax(); });
}

static void addStresses() {
  // Kernels of bodies.hpp: deformation, energies and stresses.
  add("kernelGradient", +[](Reals u, Reals F) { elements.gradient(u, F); });
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
  add("kernelDissipated", +[](Reals W) { body.dissipated(false, W); });
  add("kernelPlasticWork", +[](Reals W) { body.dissipated(true, W); });
  add("kernelLargestPlasticStrain", +[]() { return body.plasticity->largestStrain(); });
  // A and alpha of each point (7 nq), without metals none (plasticity.hpp)
  add("kernelPlasticStates", +[](Reals states) {
    states.resize(body.plasticity ? 7 * elements.nq : 0);
    if (body.plasticity) body.plasticity->states(states);
  });
  add("kernelSetPlasticStates", +[](Reals states) {
    if (body.plasticity) body.plasticity->setStates(states);
  });
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
}

static void addLoads() {
  // Kernels of loads.hpp. The first six are called at the start.
  add("kernelConditions", +[](Reals u, Reals bodyForce, Reals loadForce, Reals heldResidual,
                             Reals gasVolume, Table gas, Reals inflation, Reals v, Reals increment,
                             Reals speed) {
    loads.u = {&u};  loads.bodyForce = {&bodyForce};  loads.force = {&loadForce};
    loads.volume = {&gasVolume};  loads.gas = &gas;
    loads.inflation = {&inflation};
    supports.reaction = {&heldResidual};
    supports.v = {&v};  supports.increment = {&increment};  supports.speed = {&speed};
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

static void addSupports() {
  // Kernels of the supports of loads.hpp.
  add("kernelHeld", +[](Ints support, Ints component, Ints motion) {
    // Arrays over the unknowns; support -1: not held.
    supports.held.clear();
    for (long i = 0; i < support.N(); i++) if (support[i] >= 0)
      supports.held.push_back({int(i), int(support[i]), int(component[i]),
                               &functionOf(motion[i])});
  });
  add("kernelMoveSupports", +[](double t) { supports.move(t, 0); });
  add("kernelHold", +[]() { supports.hold(stepNow); });
  add("kernelTrackSupports", +[](Reals d, Table resultant, Reals work, Reals force, Reals missed) {
    // Resultants (3, supports), forces and M s (ndof) of the step by d; adds to the work.
    const bodies::Supports::Tracked step =
      supports.track(stepNow, Kept<double>{&d}.numbers(), int(work.N()));
    Kept<double>{&work}.numbers() += step.work;
    Kept<double>{&force}.numbers() = step.force;
    Kept<double>{&missed}.numbers() = step.missed;
    Eigen::Map<Eigen::Matrix3Xd>(&resultant(0, 0), 3, work.N()) = step.resultant;
  });
}

static void addFactor() {
  add("kernelStiffness", +[](Reals x, Reals force) {   // K x of the undeformed bodies
    body.lineariseAtRest();
    body.stiffnessTimes(x, force);
  });
  // Kernels of factor.hpp: the tangent A, its factorisation and its compliance.
  add("kernelTangentAtRest", +[](double massScale) {
    // massScale M + K of the undeformed bodies without damping
    Step rest;
    rest.massScale = massScale;
    rest.staticShare = 1;
    body.lineariseAtRest();
    elements.couple();
    sumTangents(terms, rest, elements.block);
    factor.numbers(elements);
  });
  add("kernelTangent", +[]() {             // at the last evaluation
    body.linearise(true);
    elements.couple();
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

static void addContactLaw() {
  // Kernels of contact-law.hpp.
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
  add("kernelAdhesion", +[](double energy, double range) {   // [J/m2], [m]
    touching.law.adhesion = energy;
    touching.law.range = gaps.adhesionRange = range;
  });
  add("kernelContactEnergy", +[](Reals q) { return touching.energy(q); });
  add("kernelFriction", +[](Reals code) {
    touching.law.friction = std::make_shared<expressions::Expression>(copied<double>(code));
  });
  add("kernelTractions", +[](Reals vN0, Reals gapSlip, Reals k, Reals muStatic, Reals muDynamic,
                            Reals weight, Ints sticks, double dt, long lawInstant, Reals t,
                            Reals slope) {
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
      law.at({vN0[i], k[i], muStatic[i], muDynamic[i], sticks[i] == 1, weight[i]}, x, nullptr,
             forces);
      for (long c = 0; c < m; c++) t[c * n + i] = forces.t[c];
      for (long c = 0; c < 9; c++) slope[c * n + i] = forces.slope[c / 3][c % 3];
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
                                Reals k, Reals muStatic, Reals muDynamic, Reals weight,
                                Reals area, Ints sticks) {
    touching.script = {{&q1}, {&gapSlip}, {&candidateForces}, {&force}, {&k}, {&muStatic},
                       {&muDynamic}, {&weight}, {&area}, {&sticks}};
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
  // the largest number of unknowns in the contact problem of an implicit step
  add("kernelContactUnknowns", +[]() { return long(touching.mostUnknowns); });
  add("kernelResultants", +[](Ints loaded, Ints body, Table resultant) {
    // Columns of `resultant` (6, loaded): B^T t of the loaded candidates on the bodies of their
    // contact points, first of the normal forces, then of all.
    touching.resultants(copied<int>(loaded), copied<int>(body), step.translations,
                        &resultant(0, 0));
  });
  add("kernelDampingWork", +[]() { return touching.dampingWork(); });
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
  addStresses();
  addFunctions();
  addLoads();
  addSupports();
  addFactor();
  addContactLaw();
  addStep();
  addContact();
}

LOADFUNC(addKernels)
