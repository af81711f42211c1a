// failure.hpp: fatal errors. Exports giveUp() and check().
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>

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
