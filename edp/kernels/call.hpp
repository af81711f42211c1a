// call.hpp: add(name, f) makes the C++ function f callable from FreeFEM scripts under `name`.
// f takes any number of arguments (long, double, bool, double &, std::string &, Reals, Ints,
// Table, Sparse, Callback) and returns long or nothing; FreeFEM then gets 0.
// Exports add(), the argument types, copied(), and giveUp() and check() for fatal errors.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <utility>
#include <vector>
#include "tensors.hpp"
#include "ff++.hpp"

// Ends the program with one line on stderr, as fail() of parameters.idp.
[[noreturn]] inline void giveUp(int code, const std::string &message) {
  std::fprintf(stderr, "ffimpact: %s\n", message.c_str());
  std::fflush(nullptr);
  std::_Exit(code);
}
// For a library that has run out of memory.
[[noreturn]] inline void giveUp(const std::string &what) {
  giveUp(14, "memory: not enough for " + what
    + ": take larger elements (mesh_size, contact_mesh_size) or a larger accuracy");
}
inline void check(bool good, const char *what) { if (!good) giveUp(what); }

typedef KN<double> &Reals;                 // real[int]; converts to double *
typedef KN<long> &Ints;                    // int[int]
typedef KNM<double> &Table;                // real[int, int]
typedef Matrice_Creuse<double> &Sparse;    // matrix

template <class T, class R> std::vector<T> copied(const KN<R> &array) {
  const R *from = array;
  return std::vector<T>(from, from + array.N());
}

// A script array that later calls read or fill without having it as an argument. FreeFEM may
// reallocate the numbers of an array, so the array is kept and not a pointer to its numbers.
template <class R> struct Kept {
  typedef Eigen::Matrix<R, Eigen::Dynamic, 1> Numbers;
  KN<R> *array = nullptr;
  operator R *() const { return array ? static_cast<R *>(*array) : nullptr; }
  R &operator[](long i) const { return (*array)[i]; }
  long size() const { return array->N(); }
  Eigen::Map<Numbers> numbers() const { return {static_cast<R *>(*array), array->N()}; }
};

// Script arrays for the rows of gaps as triplets: B(row, unknown) = normal, and for each tangent
// S_a(row, unknown) = slip, first all S_1.
struct JacobianRows { Ints row, unknown;  Reals normal, slip; };

// Writes values to `numbers`, or reads them from there in the same order.
struct Archive {
  std::vector<double> numbers;
  size_t at = 0;
  bool reads = false;
  double next() { return numbers[at++]; }
  template <class R> void number(R &x) {
    if (reads) x = R(next());
    else numbers.push_back(double(x));
  }
  void operator()(int &x) { number(x); }
  void operator()(long &x) { number(x); }
  void operator()(double &x) { number(x); }
  void operator()(std::vector<int> &v) {
    long n = v.size();
    number(n);
    v.resize(n);
    for (int &x : v) number(x);
  }
  template <int columns> void operator()(Eigen::Matrix<double, Eigen::Dynamic, columns> &A) {
    long rows = A.rows(), size = A.cols();
    number(rows);
    number(size);
    A.resize(rows, size);
    for (long k = 0; k < A.size(); k++) number(A.data()[k]);
  }
};

// An argument that is an expression of the script, evaluated when the kernel calls it.
struct Callback {
  Expression expression;
  Stack stack;
  long operator()() const {
    const long result = GetAny<long>((*expression)(stack));
    WhereStackOfPtr2Free(stack)->clean();
    return result;
  }
};

// Converts a FreeFEM argument to a parameter of type P. FreeFEM passes a value as itself and a
// reference as a pointer.
template <class P> struct Argument {
  typedef P Type;
  static P value(Expression e, Stack s) { return GetAny<Type>((*e)(s)); }
};
template <class P> struct Argument<P &> {
  typedef P *Type;
  static P &value(Expression e, Stack s) { return *GetAny<Type>((*e)(s)); }
};
template <> struct Argument<Callback> {
  typedef long Type;
  static Callback value(Expression e, Stack s) { return {e, s}; }
};

// One call in a script: evaluates the argument expressions, then f.
template <class F, class... A> struct Called : E_F0mps {
  F f;
  Expression argument[sizeof...(A)];
  explicit Called(F g) : f(g) {}
  template <size_t... i>
  long call(long (*)(A...), Stack s, std::index_sequence<i...>) const {
    return f(Argument<A>::value(argument[i], s)...);
  }
  template <size_t... i>
  long call(void (*)(A...), Stack s, std::index_sequence<i...>) const {
    f(Argument<A>::value(argument[i], s)...);
    return 0;
  }
  AnyType operator()(Stack s) const {
    try { return SetAny<long>(call(f, s, std::index_sequence_for<A...>())); }
    catch (const std::bad_alloc &) {
      giveUp("the compiled kernels");
    }
  }
};

// The list of argument types of a FreeFEM function, of any length.
struct Types : ArrayOfaType {
  explicit Types(std::initializer_list<aType> types) : ArrayOfaType(false) {
    n = types.size();
    t = new aType[n];
    std::copy(types.begin(), types.end(), t);
  }
};

// The FreeFEM function itself: code() creates a Called for each call in a script.
template <class R, class... A> struct Call : OneOperator {
  typedef R (*F)(A...);
  F f;
  explicit Call(F g)
    : OneOperator(atype<long>(), Types{atype<typename Argument<A>::Type>()...}), f(g) {}
  E_F0 *code(const basicAC_F0 &arguments) const {
    auto *called = new Called<F, A...>(f);
    for (size_t i = 0; i < sizeof...(A); i++) called->argument[i] = t[i]->CastTo(arguments[i]);
    return called;
  }
};
template <class R, class... A> void add(const char *name, R (*f)(A...)) {
  Global.Add(name, "(", new Call<R, A...>(f));
}
