"""Results do not depend on uninitialised memory. FreeFEM does not check the bounds of slices, and
resize() adds values that are not zero."""

import os
import shutil
import subprocess

import pytest

from ffimpact.freefem import freefem
from tests.support.direct import case

# New memory, and a zone behind it, hold FILL in every byte: for 127 a real is 1.4e306, for 0 it is
# zero.
MALLOC = r"""
#include <malloc.h>
#include <stdlib.h>
#include <string.h>
extern char **environ;
extern void *__libc_malloc(size_t), *__libc_memalign(size_t, size_t), *__libc_realloc(void *, size_t);
static const size_t zone = 2048;
static int fill(void) { for (char **e = environ; e && *e; e++) if (!strncmp(*e, "FILL=", 5)) return atoi(*e + 5);  return 0; }
static void *filled(char *p, size_t from) { if (p) memset(p + from, fill(), malloc_usable_size(p) - from);  return p; }
void *malloc(size_t n) { return filled(__libc_malloc(n + zone), 0); }
void *memalign(size_t a, size_t n) { return filled(__libc_memalign(a, n + zone), 0); }
void *aligned_alloc(size_t a, size_t n) { return memalign(a, n); }
int posix_memalign(void **p, size_t a, size_t n) { return (*p = memalign(a, n)) ? 0 : 12; }
void *realloc(void *p, size_t n) { return p ? filled(__libc_realloc(p, n + zone), n) : malloc(n); }
void *calloc(size_t k, size_t n) { char *p = malloc(k * n);  return p ? memset(p, 0, k * n) : p; }
"""
BLOCK, FRICTION = dict(radius=0.5, height=0.15, end_time=0.035), dict(angle=60, friction_static=0.5, friction_dynamic=0.3)
RUNS = {
    "closest points": ("disc-block", BLOCK | FRICTION),
    "explicit friction": ("disc", FRICTION | {"integrator": "central-difference", "law": "neohookean"}),
    "rubber": ("ball-axisymmetric", {"law": "neohookean", "nu": 0.4999}),
}


@pytest.fixture(scope="module")
def preloaded(tmp_path_factory):
    """This malloc as a library for preloading."""
    if not shutil.which("cc") or os.confstr("CS_GNU_LIBC_VERSION") is None:
        pytest.skip("needs a C compiler and glibc")
    library = tmp_path_factory.mktemp("malloc") / "fill.so"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-fno-builtin", "-x", "c", "-", "-o", library], input=MALLOC, text=True, check=True)
    return library


@pytest.mark.few(1)
@pytest.mark.parametrize("name", RUNS)
def test_unwritten_memory_changes_nothing(tmp_path, preloaded, name):
    """All digits of the history of a coarse run, with the block for the first half of the contact,
    are independent of uninitialised memory."""
    kind, values = RUNS[name]
    program, histories = freefem.find(), []
    for fill in ("000", "127"):
        environment = program.environment | {"FILL": fill, "LD_PRELOAD": f"{preloaded}:{program.environment.get('LD_PRELOAD', '')}"}
        done = program.call(*case(values | {"accuracy": 0.2, "out": tmp_path / fill}, kind), env=environment)
        assert done.returncode == 0, done.stderr
        histories.append((tmp_path / fill / "history.csv").read_text())
    assert histories[0] == histories[1]
