// numbers.hpp: rows of a table as text, each number as a stream of nine digits writes it ("%.9g").
#pragma once
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <string>
#include "call.hpp"

namespace numbers {

static void append(std::string &text, double value) {
  // Nine digits of |value| 10^(8 - e), e the exponent of the first. What is within round-off of a tie, and what is not in 1e-14 to 1e9, is
  // printf's.
  static const double power[] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
      1e19, 1e20, 1e21, 1e22};
  const double size = std::abs(value);
  const bool plain = size >= 1e-14 && size < 1e9;
  const int e = plain ? int(std::floor(std::log10(size))) : 0;
  const long double scaled = plain ? (long double)size * power[8 - e] : 0;
  const long whole = long(scaled);
  const double rest = double(scaled - whole);
  char digits[32];
  if (!(whole >= 100000000 && whole < 999999999 && std::abs(rest - 0.5) > 4e9 * LDBL_EPSILON)) {
    if (value == 0 && !std::signbit(value)) text += '0';
    else text.append(digits, std::snprintf(digits, sizeof digits, "%.9g", value));
    return;
  }
  long left = whole + (rest > 0.5);
  for (int k = 8; k >= 0; k--, left /= 10) digits[k] = char('0' + left % 10);
  const int before = e < -4 ? 1 : std::max(e + 1, 0);              // digits before the point
  int count = 9;
  while (count > std::max(before, 1) && digits[count - 1] == '0') count--;
  if (value < 0) text += '-';
  if (before == 0) text.append("0.000", 1 - e);
  text.append(digits, before);
  if (before > 0 && count > before) text += '.';
  text.append(digits + before, count - before);
  if (e < -4) text.append({'e', '-', char('0' - e / 10), char('0' - e % 10)});
}

static void write(std::ostream *&out, Table A, long rows, std::string &between) {
  std::string text;
  for (long i = 0; i < rows; i++) for (long j = 0; j < A.M(); j++) {
    append(text, A(i, j));
    text += j + 1 < A.M() ? between : "\n";
  }
  *out << text;
}

}
