// call.hpp: a C++ function as a function of FreeFEM's language, with any number of arguments.
#ifndef FFIMPACT_CALL
#define FFIMPACT_CALL
#include <utility>
#include "ff++.hpp"

template <class... A> struct Called : E_F0mps {
  long (*f)(A...);
  Expression argument[sizeof...(A)];
  template <size_t... i> long call(Stack s, std::index_sequence<i...>) const { return f(GetAny<std::decay_t<A>>((*argument[i])(s))...); }
  AnyType operator()(Stack s) const { return SetAny<long>(call(s, std::index_sequence_for<A...>())); }
};

struct Types : ArrayOfaType {
  explicit Types(std::initializer_list<aType> types) : ArrayOfaType(false) { n = types.size();  t = new aType[n];  std::copy(types.begin(), types.end(), t); }
};

template <class... A> struct Call : OneOperator {
  long (*f)(A...);
  explicit Call(long (*g)(A...)) : OneOperator(atype<long>(), Types{atype<std::decay_t<A>>()...}), f(g) {}
  E_F0 *code(const basicAC_F0 &given) const {
    auto *called = new Called<A...>;
    called->f = f;
    for (size_t i = 0; i < sizeof...(A); i++) called->argument[i] = t[i]->CastTo(given[i]);
    return called;
  }
};
template <class... A> void add(const char *name, long (*f)(A...)) { Global.Add(name, "(", new Call<A...>(f)); }
#endif
