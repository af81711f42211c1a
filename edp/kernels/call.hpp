// call.hpp: add(name, f) makes the C++ function f callable from FreeFEM scripts under `name`.
// f takes any number of arguments (long, double, bool, double &, std::string &, Reals, Ints,
// Table, Sparse) and returns a number, a text, a mesh, or nothing; FreeFEM then gets 0.
// Exports add() and the argument type Sparse.
#pragma once
#include <new>
#include <string>
#include <utility>
#include "ff++.hpp"
#include "arrays.hpp"
#include "failure.hpp"

typedef Matrice_Creuse<double> &Sparse;    // matrix

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
// Converts the result of a C++ function to that of a FreeFEM function. FreeFEM has texts and meshes
// by pointers, which it deletes behind the statement.
template <class R> struct Result {
  typedef R Type;
  static R value(R result, Stack) { return result; }
};
template <> struct Result<std::string> {
  typedef std::string *Type;
  static Type value(const std::string &text, Stack s) {
    return Add2StackOfPtr2Free(s, new std::string(text));
  }
};
template <class M> struct Result<M *> {
  typedef const M *Type;
  static Type value(M *mesh, Stack s) { return Add2StackOfPtr2FreeRC(s, mesh); }
};
template <> struct Result<void> { typedef long Type; };

// One call in a script: evaluates the argument expressions, then f.
template <class R, class... A> struct Called : E_F0mps {
  typedef typename Result<R>::Type Type;
  R (*f)(A...);
  Expression argument[sizeof...(A)];
  explicit Called(R (*g)(A...)) : f(g) {}
  template <class Q, size_t... i>
  Type call(Q (*)(A...), Stack s, std::index_sequence<i...>) const {
    return Result<R>::value(f(Argument<A>::value(argument[i], s)...), s);
  }
  template <size_t... i>
  Type call(void (*)(A...), Stack s, std::index_sequence<i...>) const {
    f(Argument<A>::value(argument[i], s)...);
    return 0;
  }
  AnyType operator()(Stack s) const {
    try { return SetAny<Type>(call(f, s, std::index_sequence_for<A...>())); }
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
    : OneOperator(atype<typename Result<R>::Type>(), Types{atype<typename Argument<A>::Type>()...}),
      f(g) {}
  E_F0 *code(const basicAC_F0 &arguments) const {
    auto *called = new Called<R, A...>(f);
    for (size_t i = 0; i < sizeof...(A); i++) called->argument[i] = t[i]->CastTo(arguments[i]);
    return called;
  }
};
template <class R, class... A> void add(const char *name, R (*f)(A...)) {
  Global.Add(name, "(", new Call<R, A...>(f));
}
