// status.hpp: how an evaluation of the bodies, a contact problem or a step ended. kernels.cpp
// defines these names for the scripts.
#pragma once

// inverted: det F <= 0, or an element collapses
enum Status { succeeded, diverged, inverted, notANumber };
