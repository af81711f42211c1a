// loads.cpp: the loads and supports of loads.hpp.
#include <cmath>
#include "loads.hpp"

namespace bodies {

using Vector = Term::Vector;

Status Loads::addForces(const Step &step, const Vector &d, Vector &residual) {
  // A pressure does exactly the work of p times the swept volume: on the straight path n da is of
  // first degree in the plane, else of second, and is averaged by its value at the middle, or by
  // Gauss' two points. The gas has its mean pressure over the change of volume, so that its work
  // equals its loss of energy.
  residual -= bodyForce.numbers();         // (1): Div P + rho0 b = rho0 A, weak, times -1
  if (load.empty()) return succeeded;
  findTractions(step);
  Vector sum = tractions;
  bool follows = false;
  for (const Load &l : load) follows = follows || l.kind != deadTraction;
  if (follows) {
    const Vector x0 = position.numbers() + u.numbers(), before = volumes(x0);
    volume.numbers() = volumes(x0 + d);
    const Vector half = 0.5 * pressures(step, before);
    const double off = axes == 2 && !revolves ? 0 : std::sqrt(1. / 12);
    for (int g = -1; g <= 1; g += 2) addPressure(x0 + (0.5 + g * off) * d, half, sum);
  }
  force.numbers() = sum;
  residual -= sum;
  return succeeded;
}

double Loads::work(const Step &, const Vector &d) const {
  const double ofLoads = load.empty() ? 0 : d.dot(force.numbers());
  return -d.dot(bodyForce.numbers()) - ofLoads;
}

void Loads::outwards(const double *outward) {
  side = Vector::Ones(weight.size());
  const Places n = normals(position.numbers()),
    out = Eigen::Map<const Places>(outward, weight.size(), 3);
  for (long p = 0; p < side.size(); p++) if (!(n.row(p).dot(out.row(p)) > 0)) side[p] = -1;
}

Loads::Places Loads::normals(const Vector &x) const {
  // Outward y_r x y_s (plane: y_r x e_z) for the nodal positions x.
  Places a = Places::Zero(weight.size(), 3), b = a, n = a;
  if (axes == 2) b.col(2).setOnes();
  for (int c = 0; c < axes; c++) {
    a.col(c) = alongR[c] * x;
    if (axes == 3) b.col(c) = alongS[c] * x;
  }
  for (long p = 0; p < side.size(); p++) n.row(p) = side[p] * a.row(p).cross(b.row(p));
  return n;
}

Vector Loads::measures(const Vector &x) const {
  // Weights times the symmetry factor; of revolution times 2 pi times the radius.
  if (!revolves) return symmetryFactor * weight;
  return 2 * M_PI * (place[0] * x).cwiseProduct(weight);
}

Vector Loads::volumes(const Vector &x) const {
  // -1/axes, of revolution -1/3, times the integral of x.n da
  const Places n = normals(x);
  Vector sum = Vector::Zero(weight.size()), all = Vector::Zero(load.size());
  for (int c = 0; c < axes; c++) sum += (place[c] * x).cwiseProduct(n.col(c));
  sum = sum.cwiseProduct(measures(x));
  for (long p = 0; p < sum.size(); p++) all[loadOf[p]] -= sum[p] / (axes + revolves);
  return all;
}

Vector Loads::areas() const {
  const Vector x = position.numbers(), area = measures(x);
  const Places n = normals(x);
  Vector all = Vector::Zero(load.size());
  Places sum = Places::Zero(load.size(), 3);
  for (long p = 0; p < area.size(); p++) {
    all[loadOf[p]] += area[p] * n.row(p).norm();
    sum.row(loadOf[p]) += area[p] * n.row(p);
  }
  for (size_t k = 0; k < load.size(); k++)
    if (load[k].kind != deadTraction) all[k] = sum.row(k).norm();
  return all;
}

double Loads::ofStep(const TimeFunction &f, const Step &step) const {
  // Mean over the step; in a static step its share at the time t.
  return step.isStatic() ? step.staticShare * f.at(step.t) : f.mean(step.t, step.dt);
}

void Loads::findTractions(const Step &step) {
  const bool same = tractions.size() > 0 && step.t == tractionStep.t && step.dt == tractionStep.dt
    && step.staticShare == tractionStep.staticShare;
  if (same) return;
  const Vector x = position.numbers(), area = measures(x), size = normals(x).rowwise().norm();
  tractionStep = step;
  tractions = Vector::Zero(x.size());
  for (int c = 0; c < axes; c++) {
    Vector push = area.cwiseProduct(size);
    for (long p = 0; p < push.size(); p++) {
      const Load &l = load[loadOf[p]];
      push[p] *= l.kind == deadTraction ? ofStep(l.function[c], step) : 0;
    }
    tractions += place[c].transpose() * push;
  }
}

double Loads::excess(int k, double v) const {
  // Above the ambient pressure [Pa]; at the volume of the start it is the gauge pressure.
  const double gauge = (*gas)(0, k), ambient = (*gas)(1, k);
  return (ambient + gauge) * std::pow((*gas)(3, k) / v, (*gas)(2, k)) - ambient;
}

Vector Loads::pressures(const Step &step, const Vector &before) {
  // Pressure of each load in the step; of a gas the mean over the change of its volume, by Gauss'
  // rule of 5 points. Gases that inflate bodies: all have the share s = s* - c (w - w*).
  static const double at[] = {0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842,
    0.953089922969332}, share[] = {0.118463442528095, 0.239314335249683, 0.284444444444444,
    0.239314335249683, 0.118463442528095};
  Vector p = Vector::Zero(load.size());
  if (inflation.size() > 0) {
    double work = 0;                       // w: sum of the pressures times the changes of volume
    for (int k = 0; k < p.size(); k++) {
      if (load[k].kind == gasPressure && !load[k].ofRigidBody) p[k] = (*gas)(0, k);
      work += p[k] * (volume[k] - unstressed[k]);
      (*gas)(3, k) = volume[k];
    }
    inflation[1] = work;
    inflation[0] = inflation[2] - inflation[4] * (work - inflation[3]);
    return inflation[0] * p;
  }
  for (int k = 0; k < p.size(); k++) {
    if (load[k].kind == followerPressure) p[k] = ofStep(load[k].function[0], step);
    if (load[k].kind != gasPressure) continue;
    if (step.isStatic()) p[k] = (*gas)(0, k);   // static steps keep the gauge pressures
    else for (int g = 0; g < 5; g++)
      p[k] += share[g] * excess(k, before[k] + at[g] * (volume[k] - before[k]));
  }
  return p;
}

void Loads::addPressure(const Vector &x, const Vector &pressure, Vector &sum) const {
  // sum += -p n da
  const Places n = normals(x);
  Vector area = measures(x);
  for (long p = 0; p < area.size(); p++) area[p] *= pressure[loadOf[p]];
  for (int c = 0; c < axes; c++)
    sum -= place[c].transpose() * Vector(n.col(c).cwiseProduct(area));
}

Status Supports::addForces(const Step &step, const Vector &, Vector &residual) {
  const Eigen::Map<const Vector> free(elements.free.data(), residual.size());
  if (reaction.size() > 0) reaction.numbers() = residual;
  residual = residual.cwiseProduct(free);
  if (!step.carries) return succeeded;
  Eigen::Map<Vector> rest(body.volume->pressureRemainder.data(), residual.size());
  if (reaction.size() > 0) reaction.numbers() += rest;
  rest.array() *= free.array();
  return succeeded;
}

double Supports::work(const Step &, const Vector &d) const {
  double sum = 0;
  for (long i = 0; i < reaction.size(); i++) if (elements.free[i] == 0) sum -= reaction[i] * d[i];
  return sum;
}

void Supports::move(double t, double dt) {
  increment.numbers().setZero();
  speed.numbers().setZero();
  for (const Held &h : held) {
    increment[h.unknown] = h.motion->at(t + dt) - h.motion->at(t);
    speed[h.unknown] = h.motion->rate(t + dt);
  }
}

void Supports::hold(const Step &step) {
  if (!step.isStatic()) move(step.t, step.dt);   // in static steps supports rest
  for (const Held &h : held)
    inertia.known[h.unknown] = step.massScale * increment[h.unknown]
      - (speed[h.unknown] - v[h.unknown]) / step.dt;
}

Supports::Tracked Supports::track(const Step &step, const Vector &d, int supports) const {
  const Vector change = step.dt * (step.massScale * d - inertia.known.numbers()),   // v1 - v0
    gained = inertia.momentum(change);
  Vector s = Vector::Zero(d.size());
  Tracked all = {s, s, Vector::Zero(supports), Eigen::Matrix3Xd::Zero(3, supports)};
  for (const Held &h : held) {
    const int i = h.unknown;
    s[i] = v[i] + 0.5 * change[i] - d[i] / step.dt;
    all.force[i] = reaction[i];
    all.resultant(h.component, h.support) += reaction[i];
    all.work[h.support] += reaction[i] * d[i] + gained[i] * s[i];
  }
  all.missed = inertia.momentum(s);
  return all;
}

}
