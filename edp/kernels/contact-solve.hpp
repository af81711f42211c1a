// contact-solve.hpp: contact and friction of a Newton step, solved on a frozen factorisation: what core/contact/solve.idp says, in the unknowns of the window.
//   tau = t(x),  x = x_w - B C B^T tau                                                                       C: compliance of the unknowns
// Newton's matrix, of the forces g on the unknowns or their moves y = C g, with K = B^T D B sparse, D = dt/dx and S = C^-1:
//   (I + K C) g = f = B^T (t - tau)   few unknowns: LU of its part where K acts
//   (S + K) y = f                     many: GMRES, preconditioned by a sparse LU of K and S where K has entries: what else S couples is soft beside K
// Springs c T^T T are points more: rows T, force c x.
#ifndef FFIMPACT_CONTACT_SOLVE
#define FFIMPACT_CONTACT_SOLVE
#include <umfpack.h>
#include <vector>
#include "contact-law.hpp"

extern "C" {
void dsymv_(const char *, const int *, const double *, const double *, const int *, const double *, const int *, const double *, double *, const int *);
void dgetrf_(const int *, const int *, double *, const int *, int *, int *);
void dgetrs_(const char *, const int *, const int *, const double *, const int *, const int *, double *, const int *, int *);
void dpotrf_(const char *, const int *, double *, const int *, int *);
void dpotri_(const char *, const int *, double *, const int *, int *);
}

namespace contact {

using Vector = std::vector<double>;
using Indices = std::vector<int>;

inline double dot(const Vector &a, const Vector &b) { double s = 0;  for (size_t i = 0; i < a.size(); i++) s += a[i] * b[i];  return s; }
inline void add(double s, const Vector &a, Vector &b) { for (size_t i = 0; i < a.size(); i++) b[i] += s * a[i]; }
inline double largest(const Vector &a) { double m = 0;  for (double v : a) if (!(std::abs(v) <= m)) { m = std::abs(v);  if (m != m) return m; }  return m; }
inline void symmetric(int n, const double *A, const Vector &x, Vector &y) {
  const double one = 1, zero = 0;
  const int step = 1;
  y.resize(n);
  if (n > 0) dsymv_("L", &n, &one, A, &n, x.data(), &step, &zero, y.data(), &step);
}

// The points of the window, its springs behind them, and their rows B on its n unknowns: a block of `kinds` values for each unknown of a point.
struct Rows {
  int n = 0, points = 0, kinds = 1;
  Indices first{0}, column, owner, heldFirst, held;                // of a point its entries; of an entry its column and point; of a column its entries
  Vector value, spring;                                            // kinds an entry; stiffness c of the springs

  int blocks() const { return first.size() - 1; }
  void begin(int unknowns, int kindsOfPoint) { n = unknowns;  kinds = kindsOfPoint;  points = 0;  first.assign(1, 0);  column.clear();  owner.clear();  value.clear();  place.assign(n, -1); }
  void entry(int j, int kind, double v) {                          // of the point that is being built
    if (place[j] < first.back()) { place[j] = column.size();  column.push_back(j);  owner.push_back(blocks());  value.resize(value.size() + kinds, 0.); }
    value[kinds * place[j] + kind] += v;
  }
  void endPoint() { first.push_back(column.size()); }
  void end(const Vector &springs) {
    spring = springs;
    points = blocks() - spring.size();
    heldFirst.assign(n + 1, 0);
    for (int j : column) heldFirst[j + 1]++;
    for (int j = 0; j < n; j++) heldFirst[j + 1] += heldFirst[j];
    held.resize(column.size());
    Indices next = heldFirst;
    for (size_t e = 0; e < column.size(); e++) held[next[column[e]]++] = e;
  }
  void push(const Vector &t, Vector &force) const {                // B^T t
    force.assign(n, 0.);
    for (size_t e = 0; e < column.size(); e++) for (int c = 0; c < kinds; c++) force[column[e]] += value[kinds * e + c] * t[kinds * owner[e] + c];
  }
  void pull(const Vector &way, Vector &move) const {               // B way
    move.assign(kinds * blocks(), 0.);
    for (size_t e = 0; e < column.size(); e++) for (int c = 0; c < kinds; c++) move[kinds * owner[e] + c] += value[kinds * e + c] * way[column[e]];
  }
 private:
  Indices place;
};

// Newton's matrix at some D, and what solves with it.
class Newton {
 public:
  int mostDense = 200, mostIterations = 10;                        // columns of K that are solved with densely; of GMRES with an older P
  bool made = false;
  ~Newton() { forget(); }
  void forget() { made = false;  iterations = 0;  if (numeric) umfpack_di_free_numeric(&numeric);  numeric = nullptr; }

  void make(const Rows &B, const Vector &slopes, const double *C, const double *S) {
    D = slopes;
    assemble(B);
    const bool dense = (int)active.size() <= mostDense;
    if (dense || iterations > mostIterations) forget();
    if (dense) factorDense(B.n, C);
    else if (!numeric) factorSparse(B.n, S);
    made = true;
  }
  bool fits(const Rows &B) const { return made && (int)Kp.size() == B.n + 1 && D.size() == (size_t)B.blocks() * B.kinds * B.kinds; }
  void slope(const Rows &B, const Vector &move, Vector &change) const {   // D move
    const int k = B.kinds;
    change.assign(move.size(), 0.);
    for (int b = 0; b < B.blocks(); b++) for (int i = 0; i < k; i++) for (int j = 0; j < k; j++) change[k * b + i] += D[k * k * b + k * i + j] * move[k * b + j];
  }
  void solve(const Vector &f, const double *C, const double *S, double goal, Vector &y) {
    if (numeric) return gmres(f, S, goal, y);
    const int n = f.size(), m = active.size(), one = 1;
    Vector g = f, h(m), w(n, 0.);
    int info;
    symmetric(n, C, f, y);
    if (m == 0) return;
    product(y, w);
    for (int j = 0; j < m; j++) h[j] = -w[active[j]];
    dgetrs_("T", &m, &one, LU.data(), &m, pivots.data(), h.data(), &m, &info);
    for (int j = 0; j < m; j++) g[active[j]] += h[j];
    symmetric(n, C, g, y);
  }

 private:
  Vector D, Kx, LU;
  Indices Kp, Ki, active, pivots, Pp, Pi;                          // K by columns; those that have entries; P = K and S where K has entries
  Vector Px;
  void *numeric = nullptr;                                         // the LU of P
  int iterations = 0;                                              // of the last GMRES

  void assemble(const Rows &B) {
    const int n = B.n, k = B.kinds;
    Indices seen(n, -1), acts(B.blocks());
    for (int b = 0; b < B.blocks(); b++) for (int i = 0; i < k * k; i++) if (D[k * k * b + i] != 0) acts[b] = 1;
    Kp.assign(1, 0);  Ki.clear();  Kx.clear();  active.clear();
    for (int j = 0; j < n; j++) {
      const int start = Ki.size();
      for (int h = B.heldFirst[j]; h < B.heldFirst[j + 1]; h++) {
        const int e = B.held[h], b = B.owner[e];
        if (!acts[b]) continue;
        double push[3] = {0, 0, 0};                                // D B, of this column
        for (int i = 0; i < k; i++) for (int c = 0; c < k; c++) push[i] += D[k * k * b + k * i + c] * B.value[k * e + c];
        for (int o = B.first[b]; o < B.first[b + 1]; o++) {
          const int row = B.column[o];
          double v = 0;
          for (int i = 0; i < k; i++) v += B.value[k * o + i] * push[i];
          if (seen[row] < start) { seen[row] = Ki.size();  Ki.push_back(row);  Kx.push_back(0.); }
          Kx[seen[row]] += v;
        }
      }
      if ((int)Ki.size() > start) active.push_back(j);
      Kp.push_back(Ki.size());
    }
  }

  void product(const Vector &y, Vector &w) const {                 // w += K y
    for (int j : active) for (int e = Kp[j]; e < Kp[j + 1]; e++) w[Ki[e]] += Kx[e] * y[j];
  }

  void factorDense(int n, const double *C) {
    const int m = active.size();
    Indices at(n, -1);
    Vector soft(m * m);                                            // C, of these
    int info;
    for (int j = 0; j < m; j++) at[active[j]] = j;
    for (int j = 0; j < m; j++) for (int i = 0; i < m; i++) soft[j * m + i] = C[(size_t)n * active[j] + active[i]];
    LU.assign(m * m, 0.);                                          // transposed: columns are added
    pivots.resize(m);
    for (int j = 0; j < m; j++) {
      for (int e = Kp[active[j]]; e < Kp[active[j] + 1]; e++) {
        double *row = &LU[at[Ki[e]] * m];
        for (int i = 0; i < m; i++) row[i] += Kx[e] * soft[j * m + i];
      }
      LU[j * m + j] += 1;
    }
    if (m > 0) dgetrf_(&m, &m, LU.data(), &m, pivots.data(), &info);
  }

  void factorSparse(int n, const double *S) {
    Pp.assign(1, 0);  Pi.clear();  Px.clear();
    for (int j = 0; j < n; j++) {
      Indices order;
      for (int e = Kp[j]; e < Kp[j + 1]; e++) order.push_back(e);
      std::sort(order.begin(), order.end(), [this](int a, int b) { return Ki[a] < Ki[b]; });
      if (order.empty()) { Pi.push_back(j);  Px.push_back(S[(size_t)n * j + j]); }
      for (int e : order) { Pi.push_back(Ki[e]);  Px.push_back(Kx[e] + S[(size_t)n * j + Ki[e]]); }
      Pp.push_back(Pi.size());
    }
    void *symbolic = nullptr;
    umfpack_di_symbolic(n, n, Pp.data(), Pi.data(), Px.data(), &symbolic, nullptr, nullptr);
    umfpack_di_numeric(Pp.data(), Pi.data(), Px.data(), symbolic, &numeric, nullptr, nullptr);
    umfpack_di_free_symbolic(&symbolic);
  }

  void gmres(const Vector &f, const double *S, double goal, Vector &y) {
    // (S + K) P^-1 p = f, y = P^-1 p (Saad and Schultz 1986), restarted
    const int n = f.size(), most = 60;
    double control[UMFPACK_CONTROL];
    umfpack_di_defaults(control);
    control[UMFPACK_IRSTEP] = 0;
    Vector left = f, w(n);
    iterations = 0;
    y.assign(n, 0.);
    for (int round = 0; round < 20; round++) {
      const double start = std::sqrt(dot(left, left));
      if (!(start > goal)) return;
      std::vector<Vector> V(1, left), Z;
      std::vector<Vector> H;
      Vector rest(1, start), cosine, sine;
      for (double &v : V[0]) v /= start;
      for (int k = 0; k < most && std::abs(rest[k]) > goal; k++) {
        iterations++;
        Z.emplace_back(n);
        umfpack_di_solve(UMFPACK_A, Pp.data(), Pi.data(), Px.data(), Z[k].data(), V[k].data(), numeric, control, nullptr);
        symmetric(n, S, Z[k], w);
        product(Z[k], w);
        Vector h(k + 2);
        for (int i = 0; i <= k; i++) { h[i] = dot(w, V[i]);  add(-h[i], V[i], w); }
        h[k + 1] = std::sqrt(dot(w, w));
        V.push_back(w);
        for (double &v : V[k + 1]) v /= std::max(h[k + 1], 1e-300);
        for (int i = 0; i < k; i++) {
          const double a = h[i];
          h[i] = cosine[i] * a + sine[i] * h[i + 1];
          h[i + 1] = cosine[i] * h[i + 1] - sine[i] * a;
        }
        const double length = std::hypot(h[k], h[k + 1]);
        cosine.push_back(h[k] / length);
        sine.push_back(h[k + 1] / length);
        h[k] = length;
        rest.push_back(-sine[k] * rest[k]);
        rest[k] *= cosine[k];
        H.push_back(h);
      }
      for (int k = (int)H.size() - 1; k >= 0; k--) {
        for (int i = k + 1; i < (int)H.size(); i++) rest[k] -= H[i][k] * rest[i];
        rest[k] /= H[k][k];
        add(rest[k], Z[k], y);
      }
      symmetric(n, S, y, left);
      product(y, left);
      for (int i = 0; i < n; i++) left[i] = f[i] - left[i];
    }
  }
};

// One contact problem after another on a window.
class Problem {
 public:
  Rows B;
  Newton newton;
  Law law;
  std::vector<Point> point;
  Indices turned;
  Vector start, tau, force;                                        // x_w; tau; B^T tau: what pushes the unknowns
  double enough = 0, sticksBelow = 0;
  int inverses = 0, mostTurns = 4, agreeingFrom = 20;              // inverses, before plain Newton with a line search takes over

  void compliance(int n, const double *looseCompliance) { C = looseCompliance;  size = n;  S.clear(); }

  int solve(long mostInverses, long &inversesOfStep) {
    // Newton; with friction on the linearised law, and with a matrix that serves on near the end and at the start of the next solve. Returns the
    // iterations, or -1.
    const int rubs = law.slips > 0;
    if (!newton.fits(B)) newton.forget();
    place();
    evaluate(nullptr);
    double biggest = 0, roundOff = 0, errorBefore = newton.made ? 1e300 : 0;
    for (double v : x) roundOff = std::max(roundOff, std::abs(v));
    const double close = 1e-13 + (rubs ? 1e-15 * roundOff / (law.dt * law.slipVelocity) : 0);
    sigma.clear();
    inverses = 0;
    for (int it = 0; inverses < 60 && inversesOfStep <= mostInverses; it++) {
      const double scale = largest(t) + largest(tau), error = largest(unbalance);
      if (it == 0) biggest = scale;
      bool done = error <= close * scale || scale == 0 || std::sqrt(dot(unbalance, unbalance)) <= enough;
      if (!done) {
        if (!(error <= 1e6 * biggest)) return -1;                  // diverges, or is not a number
        const bool searches = !rubs || inverses >= agreeingFrom;
        if (!rubs || error > (it == 0 ? 0.1 : 1e-3) * scale || error > 0.3 * errorBefore) {
          inverses++;
          if (rubs) inversesOfStep++;
          if (!searches) linearise();
          newton.make(B, slopes, C, stiffness());
        }
        errorBefore = error;
        correct(searches ? 1e-6 : 1e-3);                           // a line search asks for the true direction
        if (!advance(searches)) { if (error <= 1e-9 * scale) done = true;  else return -1; }
      }
      if (done) { if (takeSides() == 0) { B.push(tau, force);  return it; }  errorBefore = 0; }
    }
    return -1;
  }

 private:
  const double *C = nullptr;
  int size = 0;
  Vector S, x, t, slopes, unbalance, step, move, sigma;

  const double *stiffness() {                                      // S = C^-1, for many unknowns
    if (size <= newton.mostDense) return nullptr;
    if (S.empty()) {
      int info;
      S.assign(C, C + (size_t)size * size);
      dpotrf_("L", &size, S.data(), &size, &info);
      dpotri_("L", &size, S.data(), &size, &info);
      for (int j = 0; j < size; j++) for (int i = j + 1; i < size; i++) S[(size_t)size * i + j] = S[(size_t)size * j + i];
    }
    return S.data();
  }
  void comply(const Vector &f, Vector &way) const {                // B C B^T f
    Vector g, y;
    B.push(f, g);
    symmetric(B.n, C, g, y);
    B.pull(y, way);
  }
  void place() {
    comply(tau, x);
    for (size_t i = 0; i < x.size(); i++) x[i] = start[i] - x[i];
  }

  void evaluate(const std::vector<double> *at) {
    // t, D, t - tau, where `at` is given friction linearised there (slips values a point; nan: at the velocity itself)
    const int k = B.kinds;
    t.assign(x.size(), 0.);
    slopes.assign(k * x.size(), 0.);
    for (int b = 0; b < B.points; b++) {
      Forces f;
      const double *linearised = at && (*at)[law.slips * b] == (*at)[law.slips * b] ? &(*at)[law.slips * b] : nullptr;
      law.at(point[b], &x[k * b], linearised, f);
      for (int i = 0; i < k; i++) t[k * b + i] = f.t[i];
      for (int i = 0; i < k; i++) for (int j = 0; j < k; j++) slopes[k * k * b + k * i + j] = i == j ? std::max(f.slope[i][j], 0.) : f.slope[i][j];
    }
    for (size_t s = 0; s < B.spring.size(); s++) {
      const int b = B.points + s;
      t[k * b] = B.spring[s] * x[k * b];
      slopes[k * k * b] = B.spring[s];
    }
    unbalance = t;
    add(-1, tau, unbalance);
  }

  void linearise() {
    // Friction where force and velocity agree best: at the velocity x with phi(x) + x/sigma = t_T/(mu_f t_N) + v/sigma, phi taken as linear, sigma the
    // change of velocity that full friction makes in the step.
    const int k = B.kinds, slips = law.slips, blocks = B.points;
    if (sigma.empty()) {
      Vector full(x.size(), 0.), way;
      for (int b = 0; b < blocks; b++) full[k * b + 1] = t[k * b] * point[b].muStatic;
      comply(full, way);
      sigma.resize(blocks);
      for (int b = 0; b < blocks; b++) sigma[b] = std::max(way[k * b + 1] / law.dt, law.slipVelocity);
    }
    Vector at(slips * blocks, NAN);
    for (int b = 0; b < blocks; b++) {
      const Point &a = point[b];
      const double cap = std::max(1e-200, t[k * b] * (a.sticks || !law.jumps ? a.muStatic : a.muDynamic));
      double off = 0, blend[2] = {0, 0};
      for (int i = 0; i < slips; i++) off = std::max(off, std::abs(unbalance[k * b + 1 + i]));
      if (!(t[k * b] > 0 && off > 0.1 * cap)) continue;
      for (int i = 0; i < slips; i++) blend[i] = tau[k * b + 1 + i] / cap + x[k * b + 1 + i] / law.dt / sigma[b];
      const double length = std::hypot(blend[0], blend[1]);
      const double factor = length <= 1 + law.slipVelocity / sigma[b] ? 1 / (1 / law.slipVelocity + 1 / sigma[b]) : sigma[b] * (length - 1) / length;
      for (int i = 0; i < slips; i++) at[slips * b + i] = factor * blend[i];
    }
    evaluate(&at);
  }

  void correct(double share) {
    // (S + K) y = B^T (t - tau), to a share of it; step = t - tau - D B y of the forces, move = -B C B^T step
    Vector f, y, change;
    B.push(unbalance, f);
    newton.solve(f, C, S.data(), std::max(share * std::sqrt(dot(f, f)), 1e-3 * enough), y);
    B.pull(y, move);
    newton.slope(B, move, change);
    step = unbalance;
    add(-1, change, step);
    comply(step, move);
    for (double &v : move) v = -v;
  }

  bool advance(bool searches) {
    // tau and x go along step and move: fully, or to where the slope of the convex potential has become small (bisection); false where it is no descent.
    double low = 0, high = 1, s = 1, gone = 0;
    const double slopeStart = dot(unbalance, move);
    if (searches && !(slopeStart < 0)) return false;
    for (int cut = 0; cut < 40; cut++) {
      add(s - gone, step, tau);
      add(s - gone, move, x);
      gone = s;
      evaluate(nullptr);
      if (!searches) return true;
      const double slope = dot(unbalance, move);
      if (slope > -0.1 * slopeStart) high = s;                     // too far
      else if (slope < 0.9 * slopeStart && s < 1) low = s;         // hardly moved
      else return true;
      s = (low + high) / 2;
    }
    return true;
  }

  int takeSides() {
    // Points whose velocity disagrees with the side of the jump that they were solved on change it; returns how many.
    const int k = B.kinds;
    int changed = 0;
    if (!law.jumps || law.slips == 0) return 0;
    for (int b = 0; b < B.points; b++) {
      Point &a = point[b];
      const double v = (law.slips == 1 ? std::abs(x[k * b + 1]) : std::hypot(x[k * b + 1], x[k * b + 2])) / law.dt;
      if (!(t[k * b] > 0) || turned[b] > mostTurns || !(a.sticks ? v >= law.slipVelocity : v < sticksBelow)) continue;
      turned[b]++;
      if (a.sticks || turned[b] <= mostTurns) { a.sticks = !a.sticks;  changed++; }
    }
    if (changed > 0) evaluate(nullptr);
    return changed;
  }
};

}
#endif
