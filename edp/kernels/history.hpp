// history.hpp: what a law keeps at the quadrature points from step to step, in columns with names.
// A column has the values at the start of a step, and trial values for its end, which evaluations
// of the step may set. An accepted step makes the trial values those of the next start. Exports
// History.
#pragma once
#include <algorithm>
#include <deque>
#include <string>
#include "arrays.hpp"

class History {
 public:
  // Numbers [n] of every point: a tensor, or one number.
  struct Column {
    std::string name;
    int n;
    std::vector<double> start, trial;
    double *startAt(int q) { return &start[size_t(q) * n]; }
    double *trialAt(int q) { return &trial[size_t(q) * n]; }
    const double *at(bool end, int q) const { return &(end ? trial : start)[size_t(q) * n]; }
    // Sets both values.
    void set(int q, const double *values) {
      std::copy(values, values + n, startAt(q));
      std::copy(values, values + n, trialAt(q));
    }
  };

  // Adds a column for `points` points with the same initial numbers. It remains at its address.
  Column &add(const std::string &name, long points, const std::vector<double> &initial) {
    columns.push_back({name, int(initial.size()), {}, {}});
    Column &added = columns.back();
    for (long q = 0; q < points; q++)
      added.start.insert(added.start.end(), initial.begin(), initial.end());
    added.trial = added.start;
    return added;
  }
  void accept() { for (Column &c : columns) c.start = c.trial; }
  void archive(Archive &archive) {
    for (Column &c : columns) { archive(c.start);  c.trial = c.start; }
  }

 private:
  std::deque<Column> columns;
};
