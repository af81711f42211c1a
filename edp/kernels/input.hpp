// input.hpp: the file of named arrays, numbers and texts from which scripts take a scene.
#pragma once

void addInput();                           // registers the kernels of input.cpp
