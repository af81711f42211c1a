// energy.hpp: a law whose energy is an expression W (expression.hpp) of the invariants I1, I2 of C
// and of J, or of the principal stretches L1, L2, L3. Exports Energy.
#pragma once
#include "expression.hpp"
#include "laws.hpp"

namespace laws {

// The part kappa u(J) of W acts on element means of J, and the points keep W - kappa u(J). W has
// largestBulk u(J) as a term, with u(1) = u'(1) = 0, u''(1) = 1. In the expressions J is the third
// variable or L1 L2 L3.
class Energy : public Law {
 public:
  // numbers: 1 for stretches, 0 for invariants; largestBulk [Pa]; the length of the code of W; the
  // codes of W and u, the latter empty if largestBulk is 0.
  explicit Energy(const std::vector<double> &numbers);

  Symmetric stress(const Material &m, const Symmetric &C) const override;
  Symmetric algorithmicStress(const Material &m, const Symmetric &C0,
                              const Symmetric &C1) const override;
  double gradientCorrection(const Material &m, const Symmetric &M,
                            const Symmetric &H) const override;
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const override;
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const override;
  Vector<3> volume(double theta) const override;
  double volumeSlope(double theta0, double theta1) const override;
  double mostBulk() const override { return largestBulk; }

 private:
  using Point = expressions::Point;
  bool ofStretches;
  double largestBulk;
  expressions::Expression W, u;

  // The energy at points: its slope, slope and second derivatives, and change, over the variables
  double share(const Material &m) const { return m.incompressible ? 0 : m.bulk; }
  Point slope(const Material &m, const Point &x) const;
  expressions::Jet jet(double bulk, const Point &x) const;
  double change(const Material &m, const Point &x, const Point &dx) const;
  // W(M + H) - W(M - H) - S:H, with S at M
  double excess(const Material &m, const Symmetric &M, const Symmetric &H,
                const Symmetric &S) const;
  expressions::Jet overStretches(const Point &stretches) const;
};

}
