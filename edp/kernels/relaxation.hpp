// relaxation.hpp: Maxwell branches beside the law, each a spring in series with a dashpot, with
// theta = 1 - exp(-dt/tau) in a step. A branch whose time tau is shorter than the step is its
// dashpot alone, and what its spring had stored is dissipated. Exports Relaxation and
// BulkRelaxation.
#pragma once
#include "stress-terms.hpp"

namespace bodies {

// The states of branches at which the tangent was taken; empty: relaxed.
struct StatesOfTangent {
  std::vector<std::vector<double>> of;
  void keep(const std::vector<History::Column *> &states, bool stressed) {
    of.assign(states.size(), {});
    if (stressed) for (size_t k = 0; k < of.size(); k++) of[k] = states[k]->start;
  }
  void operator()(Archive &archive) { for (std::vector<double> &state : of) archive(state); }
};

// What branches of shear and of volume have in common: the states of number 0, 1 ..., the energy
// dissipated so far.
class Branched : public StressTerm {
 public:
  void linearise(bool stressed) override { ofTangent.keep(states, stressed); }
  double dissipated(Time time, int q) const override { return *lost.at(time == atEnd, q); }
  void archive(Archive &archive) override { StressTerm::archive(archive);  ofTangent(archive); }

 protected:
  std::vector<History::Column *> states;   // "state0", "state1" ...
  StatesOfTangent ofTangent;
  History::Column &lost;                   // "dissipated" [J/m3]

  // n: largest number of branches of a material.
  Branched(const Elements &all, size_t n, const std::vector<double> &initial)
    : StressTerm(all), lost(history.add("dissipated", all.nq, {0})) {
    for (size_t k = 0; k < n; k++)
      states.push_back(&history.add("state" + std::to_string(k), all.nq, initial));
    ofTangent.keep(states, false);
  }
};

// Branches of shear, modulus G. Cb = det C^(-1/3) C; the state A of a branch is the inverse of the
// viscous part of Cb, A = I at the start:
//   W = G/2 [tr(Cb A) - 3 - ln det A],   dA/dt = (Cb^-1 - A)/tau.
// In a step, with K the mean of Cb at its ends, A1 = A0 + theta (K^-1 - A0) and Am their mean,
//   S : (C1 - C0)/2 = G/2 (Cb1 - Cb0) : Am = W1 - W0 + D
// exactly, D = G/2 [f(A0) - f(A1)] >= 0, f(A) = tr(K A) - ln det A, for steps of any size.
// (Simo 1987 with a state that relaxes exactly; Gonzalez 2000 for the step.)
class Relaxation : public Branched {
 public:
  explicit Relaxation(const Elements &all);
  void addStress(const Step &step, Deformed &e) override;
  void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                 laws::Moduli &D) const override;
  void addEnergy(Time time, const Deformed &e, double *W) const override;
  void advance(const Step &step, const Deformed &e) override;
  void relax(const Deformed &e) override;

 private:
  const laws::Branches &branches(int q) const { return material(q).dampers->shear; }
  Symmetric A(size_t k, Time time, int q) const {
    return Eigen::Map<const Symmetric>(states[k]->at(time == atEnd, q));
  }
};

// Branches of volume, modulus K, state a: W = K/2 (ln J - a)^2, da/dt = (ln J - a)/tau. In a step,
// with r = (ln J0 + ln J1)/2 - a0,
//   a1 = a0 + theta r,   D = K theta (1 - theta/2) r^2.
class BulkRelaxation : public Branched {
 public:
  explicit BulkRelaxation(const Elements &all);
  void addStress(const Step &step, Deformed &e) override;
  void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                 laws::Moduli &D) const override;
  void addEnergy(Time time, const Deformed &e, double *W) const override;
  void advance(const Step &step, const Deformed &e) override;
  void relax(const Deformed &e) override;

 private:
  const laws::Branches &branches(int q) const { return material(q).dampers->bulk; }
};

}
