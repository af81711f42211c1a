// blocks.cpp: the blocks of blocks.hpp, by BLAS and LAPACK.
#include <map>
#include "blocks.hpp"

#define LAPACK(Real, p) \
extern "C" { \
void p##symv_(const char *, const int *, const Real *, const Real *, const int *, const Real *, \
              const int *, const Real *, Real *, const int *); \
void p##potrf_(const char *, const int *, Real *, const int *, int *); \
void p##potri_(const char *, const int *, Real *, const int *, int *); \
} \
inline void multiply(int n, const Real *A, const Real *x, Real *y) { \
  const Real alpha = 1, beta = 0; \
  const int step = 1; \
  p##symv_("L", &n, &alpha, A, &n, x, &step, &beta, y, &step); \
} \
inline bool invertLower(int n, Real *A) { \
  int info; \
  p##potrf_("L", &n, A, &n, &info); \
  if (info == 0) p##potri_("L", &n, A, &n, &info); \
  return info == 0; \
}
LAPACK(double, d)
LAPACK(float, s)
#undef LAPACK

namespace contact {

template<class Real> Blocks<Real>::Blocks(const Indices &part) : placeOf(part.size()) {
  std::map<int, int> number;               // of the block of a part
  std::vector<Indices> members;
  for (size_t i = 0; i < part.size(); i++) {
    const auto [at, isNew] = number.insert({part[i], int(members.size())});
    if (isNew) members.emplace_back();
    blockOf.push_back(at->second);
    placeOf[i] = int(members[at->second].size());
    members[at->second].push_back(int(i));
  }
  for (const Indices &of : members) {
    member.insert(member.end(), of.begin(), of.end());
    firstOf.push_back(int(member.size()));
    start.push_back(start.back() + of.size() * of.size());
  }
  values.assign(start.back(), Real(0));
}

template<class Real> Blocks<Real>::Blocks(const Vector &diagonal)
  : placeOf(diagonal.size(), 0), values(diagonal.begin(), diagonal.end()) {
  for (int i = 0; i < diagonal.size(); i++) {
    member.push_back(i);
    blockOf.push_back(i);
    firstOf.push_back(i + 1);
    start.push_back(i + 1);
  }
}

template<class Real> Vector Blocks<Real>::times(const Vector &x) const {
  Vector y(x.size());
  std::vector<Real> from, to;
  for (int b = 0; b < count(); b++) {
    const int n = sizeOf(b), *own = membersOf(b);
    if (n == 1) { y[own[0]] = *numbersOf(b) * x[own[0]];  continue; }
    from.resize(n);
    to.resize(n);
    for (int i = 0; i < n; i++) from[i] = Real(x[own[i]]);
    multiply(n, numbersOf(b), from.data(), to.data());
    for (int i = 0; i < n; i++) y[own[i]] = to[i];
  }
  return y;
}

template<class Real> bool Blocks<Real>::invert() {
  for (int b = 0; b < count(); b++) {
    const int n = sizeOf(b);
    Real *A = numbersOf(b);
    if (n == 1 && *A > 0) { *A = 1 / *A;  continue; }
    if (!invertLower(n, A)) return false;
    for (int j = 0; j < n; j++)
      for (int i = j + 1; i < n; i++) A[size_t(n) * i + j] = A[size_t(n) * j + i];
  }
  return true;
}

template class Blocks<double>;
template class Blocks<float>;

}
