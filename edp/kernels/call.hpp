// call.hpp: a C++ function as a function of FreeFEM's language, with any number of arguments: add(name, function).
#pragma once
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>
#include "ff++.hpp"

// A library that had no memory, or was called with what it does not take: one line on stderr, and out with exit code 14.
[[noreturn]] inline void giveUp(const char *what) {
  std::fprintf(stderr, "ffimpact: memory: %s: take larger elements (mesh_size, contact_mesh_size) or a larger accuracy\n", what);
  std::fflush(nullptr);
  std::_Exit(14);
}
inline void check(bool good, const char *what) { if (!good) giveUp(what); }

typedef KN<double> &Reals;                 // real[int], also where double * is asked for
typedef KN<long> &Ints;                    // int[int]
typedef KNM<double> &Table;                // real[int, int]
typedef Matrice_Creuse<double> &Sparse;    // matrix

template <class T, class R> std::vector<T> copied(const KN<R> &given) {
  const R *from = given;
  return std::vector<T>(from, from + given.N());
}

// What FreeFEM has of a parameter: the value, or a pointer for a reference.
template <class P> struct Given {
  typedef P Type;
  static P of(AnyType a) { return GetAny<Type>(a); }
};
template <class P> struct Given<P &> {
  typedef P *Type;
  static P &of(AnyType a) { return *GetAny<Type>(a); }
};

template <class F, class... A> struct Called : E_F0mps {
  F f;
  Expression argument[sizeof...(A)];
  explicit Called(F g) : f(g) {}
  template <size_t... i> long call(long (*)(A...), Stack s, std::index_sequence<i...>) const {
    return f(Given<A>::of((*argument[i])(s))...);
  }
  template <size_t... i> long call(void (*)(A...), Stack s, std::index_sequence<i...>) const {
    f(Given<A>::of((*argument[i])(s))...);
    return 0;
  }
  AnyType operator()(Stack s) const {
    try { return SetAny<long>(call(f, s, std::index_sequence_for<A...>())); }
    catch (const std::bad_alloc &) { giveUp("there is not enough of it for the compiled kernels"); }
  }
};

struct Types : ArrayOfaType {
  explicit Types(std::initializer_list<aType> types) : ArrayOfaType(false) {
    n = types.size();
    t = new aType[n];
    std::copy(types.begin(), types.end(), t);
  }
};

template <class R, class... A> struct Call : OneOperator {
  typedef R (*F)(A...);
  F f;
  explicit Call(F g) : OneOperator(atype<long>(), Types{atype<typename Given<A>::Type>()...}), f(g) {}
  E_F0 *code(const basicAC_F0 &given) const {
    auto *called = new Called<F, A...>(f);
    for (size_t i = 0; i < sizeof...(A); i++) called->argument[i] = t[i]->CastTo(given[i]);
    return called;
  }
};
template <class R, class... A> void add(const char *name, R (*f)(A...)) { Global.Add(name, "(", new Call<R, A...>(f)); }
