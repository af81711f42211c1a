// contact-solve.cpp: the contact problem of contact-solve.hpp, by LAPACK for few unknowns and by
// UMFPACK for many.
#include <algorithm>
#include <cmath>
#include <umfpack.h>
#include "contact-solve.hpp"
#include "failure.hpp"

extern "C" {
void dgetrf_(const int *, const int *, double *, const int *, int *, int *);
void dgetrs_(const char *, const int *, const int *, const double *, const int *, const int *,
             double *, const int *, int *);
}

namespace contact {

static double largest(const Vector &a) {
  return a.size() == 0 ? 0 : a.lpNorm<Eigen::Infinity>();
}

void Rows::begin(int unknowns, int rowsOfBlock) {
  const std::shared_ptr<const Pattern> patternBefore = pattern;
  *this = Rows();
  n = unknowns;
  gapRows = rowsOfBlock;
  pattern = patternBefore;
}

void Rows::entry(int j, int kind, double v) {
  const int e = std::find(column.begin() + first.back(), column.end(), j) - column.begin();
  if (e == (int)column.size()) {
    column.push_back(j);
    blockOf.push_back(blocks());
    value.resize(value.size() + gapRows, 0.);
  }
  value[gapRows * e + kind] += v;
}

void Rows::end(const Vector &geometricTerms) {
  geometric = geometricTerms;
  points = blocks() - geometric.size();
}

void Rows::transposeTimes(const Vector &t, Vector &force) const {
  force = Vector::Zero(n);
  for (size_t e = 0; e < column.size(); e++)
    for (int c = 0; c < gapRows; c++)
      force[column[e]] += value[gapRows * e + c] * t[gapRows * blockOf[e] + c];
}

void Rows::times(const Vector &increment, Vector &move) const {
  move = Vector::Zero(gapRows * blocks());
  for (size_t e = 0; e < column.size(); e++)
    for (int c = 0; c < gapRows; c++)
      move[gapRows * blockOf[e] + c] += value[gapRows * e + c] * increment[column[e]];
}

void Rows::slope(const Vector &D, const Vector &move, Vector &change) const {
  change = Vector::Zero(move.size());
  for (int b = 0; b < blocks(); b++)
    for (int i = 0; i < gapRows; i++)
      for (int j = 0; j < gapRows; j++)
        change[gapRows * b + i] += D[gapRows * (gapRows * b + i) + j] * move[gapRows * b + j];
}

template <class Function> void Rows::stiffness(const Vector &D, Function add) const {
  for (int b = 0, t = 0; b < blocks(); b++) {
    const double *slopes = &D[gapRows * gapRows * b];
    if (std::all_of(slopes, slopes + gapRows * gapRows, [](double d) { return d == 0; })) {
      t += entries(b) * entries(b);
      continue;
    }
    for (int e = first[b]; e < first[b + 1]; e++) {
      double increment[3] = {}, *to = increment;   // column of D B
      for (int i = 0; i < gapRows; i++, to++)
        for (int c = 0; c < gapRows; c++) *to += slopes[gapRows * i + c] * value[gapRows * e + c];
      for (int o = first[b]; o < first[b + 1]; o++, t++) {
        double sum = 0;
        for (int i = 0; i < gapRows; i++) sum += value[gapRows * o + i] * increment[i];
        add(t, column[o], column[e], sum);
      }
    }
  }
}

void Rows::makePattern() {
  if (pattern && pattern->start.size() == (size_t)n + 1 && pattern->first == first
      && pattern->column == column)
    return;
  Indices I, J;
  void *symbolic = nullptr;
  for (int b = 0; b < blocks(); b++)
    for (int e = first[b]; e < first[b + 1]; e++)
      for (int o = first[b]; o < first[b + 1]; o++) {
        I.push_back(column[o]);
        J.push_back(column[e]);
      }
  for (int j = 0; j < n; j++) { I.push_back(j);  J.push_back(j); }
  Pattern made{first, column, Indices(n + 1), Indices(I.size()), Indices(I.size()), nullptr};
  check(umfpack_di_triplet_to_col(n, n, I.size(), I.data(), J.data(), nullptr, made.start.data(),
                                  made.row.data(), nullptr, made.place.data()) == UMFPACK_OK
        && umfpack_di_symbolic(n, n, made.start.data(), made.row.data(), nullptr, &symbolic,
                               nullptr, nullptr) == UMFPACK_OK,
        "the pattern of the contact");
  made.symbolic.reset(symbolic, [](void *s) { umfpack_di_free_symbolic(&s); });
  pattern = std::make_shared<const Pattern>(std::move(made));
}

void Newton::stiffen(const Blocks<double> &C, Blocks<double> &S) {
  S = {};
  rounded = C.cast<float>();
  if ((C.isDiagonal() || C.size() > mostDense) && rounded.invert()) return;
  S = C;
  S.invert();
  rounded = S.cast<float>();
}

bool Newton::fits(const Rows &B) const {
  return made && n == B.n && D.size() == B.blocks() * B.gapRows * B.gapRows;
}

void Newton::make(Rows &B, const Vector &slopes, const Blocks<double> &S) {
  D = slopes;
  n = B.n;
  dense = n <= mostDense && !rounded.isDiagonal();
  made = true;
  if (dense) return factorDense(B, S);
  B.makePattern();
  if (!numeric || pattern != B.pattern || iterations > mostIterations) factorSparse(B);
}

void Newton::solve(const Rows &B, const Vector &f, double goal, Vector &y) {
  const int rightSides = 1;
  int info;
  if (!dense) return conjugate(B, f, goal, y);
  y = f;
  if (n > 0)
    dgetrs_("N", &n, &rightSides, LU.data(), &n, pivots.data(), y.data(), &n, &info);
}

void Newton::factorDense(const Rows &B, const Blocks<double> &S) {   // LU of S + K
  int info;                                    // > 0 if singular; the solution is then nan
  LU.resize((size_t)n * n);
  for (int j = 0; j < n; j++) for (int i = 0; i < n; i++) LU[(size_t)n * j + i] = S.at(i, j);
  pivots.resize(n);
  B.stiffness(D, [this](int, int i, int j, double K) { LU[(size_t)n * j + i] += K; });
  if (n > 0) dgetrf_(&n, &n, LU.data(), &n, pivots.data(), &info);
}

void Newton::factorSparse(const Rows &B) {   // P and its LU
  void *made = nullptr;
  pattern = B.pattern;
  const Indices &start = pattern->start, &row = pattern->row;
  P.resize(start[n]);
  for (int j = 0; j < n; j++) for (int e = start[j]; e < start[j + 1]; e++)
    P[e] = rounded.at(row[e], j);
  B.stiffness(D, [&](int t, int, int, double K) { P[pattern->place[t]] += K; });
  const int status = umfpack_di_numeric(start.data(), row.data(), P.data(),
                                        pattern->symbolic.get(), &made, nullptr, nullptr);
  check(status == UMFPACK_OK || status == UMFPACK_WARNING_singular_matrix,
        "the matrix of the contact");
  numeric.reset(made, [](void *s) { umfpack_di_free_numeric(&s); });
}

void Newton::conjugate(const Rows &B, const Vector &f, double goal, Vector &y) {
  // Generalised conjugate residuals (Eisenstat, Elman, Schultz 1983); the iterates are those of
  // GMRES. Ends at a residual of norm `goal`, after 200 iterations at the latest.
  double control[UMFPACK_CONTROL];
  umfpack_di_defaults(control);
  control[UMFPACK_IRSTEP] = 0;
  Vector residual = f, move, change, more;
  std::vector<Vector> increments, images;
  y = Vector::Zero(n);
  for (iterations = 0; iterations < 200 && residual.norm() > goal; iterations++) {
    Vector increment(n);
    const int status = umfpack_di_solve(UMFPACK_A, pattern->start.data(), pattern->row.data(),
                                        P.data(), increment.data(), residual.data(),
                                        numeric.get(), control, nullptr);
    check(status == UMFPACK_OK || status == UMFPACK_WARNING_singular_matrix,
          "the solution of the contact");
    Vector image = rounded.times(increment);
    B.times(increment, move);
    B.slope(D, move, change);
    B.transposeTimes(change, more);
    image += more;
    for (size_t k = 0; k < increments.size(); k++) {
      const double h = image.dot(images[k]);
      image -= h * images[k];
      increment -= h * increments[k];
    }
    const double scale = 1 / std::max(image.norm(), 1e-300),
      along = scale * scale * residual.dot(image);
    y += along * increment;
    residual -= along * image;
    increments.push_back(scale * increment);
    images.push_back(scale * image);
  }
}

Status Problem::solve(long mostContactMatrices, long &contactMatrices) {
  const int hasFriction = law.slips > 0;
  newton.made = newton.fits(B);
  place();
  evaluate(nullptr);
  double roundOff = 0, errorBefore = newton.made ? 1e300 : 0;
  roundOff = largest(x);
  const double close = 1e-13 + (hasFriction ? 1e-15 * roundOff / (law.dt * law.slipVelocity) : 0);
  sigma.resize(0);
  matrices = 0;
  for (int it = 0; matrices < 60 && contactMatrices <= mostContactMatrices; it++) {
    const double scale = largest(t) + largest(tau), error = largest(unbalance);
    bool done = error <= close * scale || scale == 0 || unbalance.norm() <= forceTolerance;
    if (!done) {
      if (!std::isfinite(error)) return diverged;
      const bool searches = !hasFriction || matrices >= lineSearchFrom;
      const bool direct = !hasFriction && correctForces();
      if (!hasFriction || error > (it == 0 ? 0.1 : 1e-3) * scale || error > 0.3 * errorBefore) {
        matrices++;
        if (hasFriction) contactMatrices++;
        if (!searches) linearise();
        if (!direct) { stiffen();  newton.make(B, slopes, S); }
      }
      errorBefore = error;
      if (!direct) correct(searches ? 1e-6 : 1e-3);   // a line search needs an accurate direction
      if (!advance(searches)) { if (error <= 1e-9 * scale) done = true;  else return diverged; }
    }
    if (done) {
      if (updateStatuses() == 0) { B.transposeTimes(tau, force);  return succeeded; }
      errorBefore = 0;
    }
  }
  return diverged;
}

void Problem::stiffen() {   // S = C^-1
  if (stiff) return;
  stiff = true;
  newton.stiffen(C, S);
}

void Problem::displace(const Vector &f, Vector &increment) const {   // increment = B C B^T f
  Vector g;
  B.transposeTimes(f, g);
  B.times(C.times(g), increment);
}

void Problem::place() {   // x = x_w - B C B^T tau
  displace(tau, x);
  x = start - x;
}

void Problem::evaluate(const Vector *at) {
  // t, D and t - tau at x; negative diagonal terms of D count as 0 without adhesion. `at`, if not
  // null, has the velocity at which friction is linearised, slips values for each point; nan: not
  // linearised.
  const int k = B.gapRows;
  t = Vector::Zero(x.size());
  slopes = Vector::Zero(k * x.size());
  for (int b = 0; b < B.points; b++) {
    Forces f;
    const double *linearised = at && (*at)[law.slips * b] == (*at)[law.slips * b]
      ? &(*at)[law.slips * b] : nullptr;
    law.at(point[b], &x[k * b], linearised, f);
    for (int i = 0; i < k; i++) t[k * b + i] = f.t[i];
    for (int i = 0; i < k; i++)
      for (int j = 0; j < k; j++)
        slopes[k * k * b + k * i + j] =
          i == j && law.range == 0 ? std::max(f.slope[i][j], 0.) : f.slope[i][j];
  }
  for (size_t s = 0; s < B.geometric.size(); s++) {
    const int b = B.points + s;
    t[k * b] = B.geometric[s] * x[k * b];
    slopes[k * k * b] = B.geometric[s];
  }
  unbalance = t - tau;
}

void Problem::linearise() {
  // Linearises friction at the velocity w that fits force and velocity best: phi(w) + w/sigma =
  // t_T/(mu_f t_N) + v/sigma with the linear phi; sigma [m/s] is the velocity change that full
  // friction causes in the step (resolvent: Alart and Curnier 1991; de Saxce and Feng 1998).
  // Linearised at v, Newton's method oscillates: an inexact v does not determine the force.
  const int k = B.gapRows, slips = law.slips, blocks = B.points;
  if (sigma.size() == 0) {
    Vector full = Vector::Zero(x.size()), increment;
    for (int b = 0; b < blocks; b++) full[k * b + 1] = t[k * b] * point[b].muStatic;
    displace(full, increment);
    sigma.resize(blocks);
    for (int b = 0; b < blocks; b++)
      sigma[b] = std::max(increment[k * b + 1] / law.dt, law.slipVelocity);
  }
  Vector at = Vector::Constant(slips * blocks, NAN);
  for (int b = 0; b < blocks; b++) {
    const Candidate &a = point[b];
    const double cap = std::max(1e-200,
      t[k * b] * (a.sticks || !law.jumps ? a.muStatic : a.muDynamic));
    double off = 0, blend[2] = {0, 0};
    for (int i = 0; i < slips; i++) off = std::max(off, std::abs(unbalance[k * b + 1 + i]));
    if (!(t[k * b] > 0 && off > 0.1 * cap)) continue;
    for (int i = 0; i < slips; i++)
      blend[i] = tau[k * b + 1 + i] / cap + x[k * b + 1 + i] / law.dt / sigma[b];
    const double length = std::hypot(blend[0], blend[1]);
    const double factor = length <= 1 + law.slipVelocity / sigma[b]
      ? 1 / (1 / law.slipVelocity + 1 / sigma[b]) : sigma[b] * (length - 1) / length;
    for (int i = 0; i < slips; i++) at[slips * b + i] = factor * blend[i];
  }
  evaluate(&at);
}

bool Problem::correctForces() {
  // The same increments as correct(), without friction, by a Cholesky factorisation for the loaded
  // points a, D > 0: (D^-1 + G)_aa step_a = (D^-1 (t - tau) - G r)_a, G = B C B^T; r = t - tau at
  // the other points, where step = r. Returns false for a diagonal C, many points, or if it fails.
  if (C.isDiagonal() || law.range > 0) return false;
  Indices loaded;
  step = unbalance;
  for (int b = 0; b < B.blocks(); b++) if (slopes[b] > 0) { loaded.push_back(b);  step[b] = 0; }
  const int m = loaded.size();
  if (m > mostLoaded) return false;
  displace(step, move);
  Eigen::MatrixXd yielded = Eigen::MatrixXd::Zero(B.n, m), A(m, m);   // C B_a^T
  Vector right(m);
  for (int j = 0; j < m; j++)
    for (int b = loaded[j], e = B.first[b]; e < B.first[b + 1]; e++)
      C.addColumn(B.column[e], B.value[e], &yielded(0, j));
  for (int i = 0; i < m; i++) {
    const int b = loaded[i];
    A.row(i).setZero();
    for (int e = B.first[b]; e < B.first[b + 1]; e++)
      A.row(i) += B.value[e] * yielded.row(B.column[e]);
    A(i, i) += 1 / slopes[b];
    right[i] = unbalance[b] / slopes[b] - move[b];
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (factor.info() != Eigen::Success) return false;
  right = factor.solve(right);
  for (int i = 0; i < m; i++) step[loaded[i]] = right[i];
  displace(step, move);
  move = -move;
  return true;
}

void Problem::correct(double share) {
  // Solves (S + K) y = B^T (t - tau) to a relative residual `share`. Increments: of the forces
  // step = t - tau - D B y, of gap and slip move = -B C B^T step.
  Vector f, y, change;
  B.transposeTimes(unbalance, f);
  newton.solve(B, f, std::max(share * f.norm(), 1e-2 * forceTolerance), y);
  B.times(y, move);
  B.slope(newton.D, move, change);
  step = unbalance - change;
  displace(step, move);
  move = -move;
}

bool Problem::advance(bool searches) {
  // Adds `step` to tau and `move` to x, fully or, with a line search, up to the point where the
  // slope of the convex potential has become small (bisection). Returns false if `move` is not a
  // descent direction.
  double low = 0, high = 1, s = 1, applied = 0;
  const double slopeStart = unbalance.dot(move);
  if (searches && !(slopeStart < 0)) return false;
  for (int cut = 0; cut < 40; cut++) {
    tau += (s - applied) * step;
    x += (s - applied) * move;
    applied = s;
    evaluate(nullptr);
    if (!searches) return true;
    const double slope = unbalance.dot(move);
    if (slope > -0.1 * slopeStart) high = s;   // too far
    else if (slope < 0.9 * slopeStart && s < 1) low = s;   // too short
    else return true;
    s = (low + high) / 2;
  }
  return true;
}

int Problem::updateStatuses() {
  // Changes the stick or slip status of points whose velocity contradicts it. Returns the number
  // of changes. A point that exceeds mostStatusChanges keeps slipping.
  const int k = B.gapRows;
  int changed = 0;
  if (!law.jumps || law.slips == 0) return 0;
  for (int b = 0; b < B.points; b++) {
    Candidate &a = point[b];
    const double v = (law.slips == 1 ? std::abs(x[k * b + 1])
      : std::hypot(x[k * b + 1], x[k * b + 2])) / law.dt;
    if (!(t[k * b] > 0) || statusChanges[b] > mostStatusChanges
        || !(a.sticks ? v >= law.slipVelocity : v < sticksBelow))
      continue;
    statusChanges[b]++;
    if (a.sticks || statusChanges[b] <= mostStatusChanges) { a.sticks = !a.sticks;  changed++; }
  }
  if (changed > 0) evaluate(nullptr);
  return changed;
}

}
