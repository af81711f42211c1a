// kernels.cpp: the plugin of FreeFEM that edp/kernels.idp loads: every kernel and its name in the scripts.
#include <cholmod.h>   // first: without SuiteSparse's headers the build ends at once
#include "ff++.hpp"

static void addKernels() {}

LOADFUNC(addKernels)
