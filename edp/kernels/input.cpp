// input.cpp: files of named arrays, which Python writes (ffimpact/freefem/arrays.py). A file begins
// with the word ffinput1, the CRC-32 of all entries and their length, in 8 bytes each. An entry is
// its name in 48 bytes, its kind (real, whole or text) in 8, its rows and columns in 8 each, then
// the rows as doubles or long integers. Entries of texts are one row of bytes, in which each text
// ends with a zero byte.
#include "call.hpp"
#include "input.hpp"
#include <cstdint>
#include <cstring>
#include <deque>
#include <fstream>
#include <iterator>
#include <map>

namespace {
using namespace Fem2D;
// One interface to the elements of FreeFEM's meshes in the plane and in space.
void set(Triangle &t, Vertex *v, int *at, int region) { t.set(v, at[0], at[1], at[2], region); }
void set(BoundaryEdge &e, Vertex *v, int *at, int label) {
  e = BoundaryEdge(v, at[0], at[1], label);
}
template <class E> void set(E &element, Vertex3 *v, int *at, int label) {
  element.set(v, at, label);
}

struct Entry {
  std::string kind;
  long rows, columns;
  const char *data;
};
std::deque<std::vector<char>> contents;    // of the files read so far
std::map<std::string, Entry> entries;

uint32_t checksum(const char *data, size_t size) {
  // CRC-32, as Python's zlib.crc32.
  uint32_t table[256], crc = ~0u;
  for (uint32_t n = 0; n < 256; n++) {
    table[n] = n;
    for (int bit = 0; bit < 8; bit++) table[n] = table[n] >> 1 ^ (table[n] & 1 ? 0xEDB88320u : 0);
  }
  for (size_t i = 0; i < size; i++) crc = crc >> 8 ^ table[(crc ^ data[i]) & 0xFF];
  return ~crc;
}

long wholeAt(const char *data) {
  long number;
  std::memcpy(&number, data, sizeof number);
  return number;
}

bool readFile(const std::string &path) {
  // Adds the entries of a file. Returns whether it is such a file, and complete.
  const size_t head = 24, entryHead = 72;
  std::ifstream file(path, std::ios::binary);
  contents.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  const std::vector<char> &bytes = contents.back();
  if (bytes.size() < head || std::memcmp(bytes.data(), "ffinput1", 8) != 0) return false;
  const size_t size = bytes.size() - head;
  const char *at = bytes.data() + head, *const end = at + size;
  if (size_t(wholeAt(at - 8)) != size || wholeAt(at - 16) != long(checksum(at, size))) return false;
  while (at < end) {
    const Entry e = {at + 48, wholeAt(at + 56), wholeAt(at + 64), at + entryHead};
    entries[at] = e;
    at += entryHead + e.rows * e.columns * (e.kind == "text" ? 1 : 8);
  }
  return true;
}

const Entry &entry(const std::string &name, const char *kind) {
  const auto found = entries.find(name);
  if (found == entries.end() || found->second.kind != kind)
    giveUp(10, std::string("scene: its file has no ") + kind + " entry '" + name
      + "' (accepted: the file that `python -m ffimpact run` prepares)");
  return found->second;
}

template <class R> const char *kindOf();
template <> const char *kindOf<double>() { return "real"; }
template <> const char *kindOf<long>() { return "whole"; }

template <class R> void fill(KN<R> &array, std::string &name) {
  const Entry &e = entry(name, kindOf<R>());
  array.resize(e.rows * e.columns);
  std::memcpy(static_cast<R *>(array), e.data, 8 * array.N());
}
template <class R> void fillTable(KNM<R> &table, std::string &name) {
  // The rows of the entry become the columns of the table.
  const Entry &e = entry(name, kindOf<R>());
  table.resize(e.columns, e.rows);
  std::memcpy(static_cast<R *>(table), e.data, 8 * table.N() * table.M());
}

template <class R> const R *numbers(const char *name, long &rows) {
  const Entry &e = entry(name, kindOf<R>());
  rows = e.rows;
  return reinterpret_cast<const R *>(e.data);
}

template <class Mesh, class Vertex, class Cell, class Side, int axes> Mesh *makeMesh() {
  // The mesh of the entries mesh.points, cells, regions, sides, labels.
  long nv, nt, ns;
  const double *x = numbers<double>("mesh.points", nv);
  const long *region = numbers<long>("mesh.regions", nt), *label = numbers<long>("mesh.labels", ns),
    *corners = numbers<long>("mesh.cells", nt), *ends = numbers<long>("mesh.sides", ns);
  Vertex *vertex = new Vertex[nv];
  Cell *cell = new Cell[nt];
  Side *side = new Side[ns];
  for (long v = 0; v < nv; v++) for (int c = 0; c < axes; c++) vertex[v][c] = x[axes * v + c];
  int at[axes + 1];
  for (long t = 0; t < nt; t++) {
    std::copy(corners + (axes + 1) * t, corners + (axes + 1) * (t + 1), at);
    set(cell[t], vertex, at, region[t]);
  }
  for (long s = 0; s < ns; s++) {
    std::copy(ends + axes * s, ends + axes * (s + 1), at);
    set(side[s], vertex, at, label[s]);
  }
  return new Mesh(nv, nt, ns, vertex, cell, side);
}

std::string textOf(std::string &name, long k) {
  // Text k, from 0.
  const char *at = entry(name, "text").data;
  for (; k > 0; k--) at += std::strlen(at) + 1;
  return at;
}
}

void addInput() {
  add("inputFile", +[](std::string &path) { return long(readFile(path)); });
  add("inputReal", +[](std::string &name) {
    const bool isWhole = entries.count(name) && entries[name].kind == "whole";
    double number = 0;
    if (!isWhole) std::memcpy(&number, entry(name, "real").data, sizeof number);
    return isWhole ? double(wholeAt(entries[name].data)) : number;
  });
  add("inputInt", +[](std::string &name) { return wholeAt(entry(name, "whole").data); });
  add("inputHas", +[](std::string &name) { return long(entries.count(name)); });
  add("inputText", textOf);
  add("inputMesh", +[]() {
    Mesh *made = makeMesh<Mesh, Vertex, Triangle, BoundaryEdge, 2>();
    made->MakeQuadTree();
    return made;
  });
  add("inputMesh3", +[]() {
    Mesh3 *made = makeMesh<Mesh3, Vertex3, Tet, Triangle3, 3>();
    made->BuildGTree();
    return made;
  });
  add("inputArray", fill<double>);
  add("inputArray", fill<long>);
  add("inputTable", fillTable<double>);
  add("inputTable", fillTable<long>);
}
