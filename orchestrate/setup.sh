#!/usr/bin/env bash
# Installs what is missing and nothing else: FreeFem++ with its plugins, OpenBLAS, the libraries that
# gmsh's wheel needs, and a .venv with the packages that requirements.lock pins. For Debian and Ubuntu.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { echo "setup: $*" >&2; }
stop() { say "$*"; exit 13; }   # of the run contract: something is missing
PATH=$PATH:/sbin:/usr/sbin
libraries=$(ldconfig -p)
has_library() { [[ $libraries == *"$1"* ]]; }
freefem=${FREEFEM:-FreeFem++}
probe() { answer=$("$freefem" -nw -ne -v 0 edp/program/version.edp </dev/null 2>&1) && [[ $answer == *version* ]]; }

find_python() {   # the first python that is new enough and can make a venv
  local candidate
  for candidate in python3 python3.14 python3.13 python3.12 python3.11 /usr/bin/python3; do
    if "$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
      echo "$candidate"; return
    fi
  done
  return 1
}

missing=()
if ! command -v "$freefem" >/dev/null; then missing+=(freefem++ libfreefem++)
elif ! probe && ! compgen -G '/usr/lib/freefem++/*.so' >/dev/null; then missing+=(libfreefem++); fi
has_library libopenblas.so || missing+=(libopenblas0-pthread)
[ -x .venv/bin/python ] || find_python >/dev/null || missing+=(python3 python3-venv)
while read -r library package; do
  has_library "$library" || missing+=("$package")
done <<'LIBRARIES'
libGL.so.1          libgl1
libGLU.so.1         libglu1-mesa
libX11.so.6         libx11-6
libXcursor.so.1     libxcursor1
libXext.so.6        libxext6
libXfixes.so.3      libxfixes3
libXft.so.2         libxft2
libXinerama.so.1    libxinerama1
libXrender.so.1     libxrender1
libfontconfig.so.1  libfontconfig1
libgomp.so.1        libgomp1
LIBRARIES

install() {   # packages; 1 without root, sudo or apt-get
  local root=""
  if [ "$(id -u)" != 0 ]; then root=$(command -v sudo) || return 1; fi
  command -v apt-get >/dev/null || return 1
  apt() { $root env DEBIAN_FRONTEND=noninteractive apt-get -qq "$@" </dev/null >/dev/null; }
  say "installing $*"
  apt update
  local wanted=() package   # where the plugins come with freefem++ itself there is no libfreefem++
  for package; do
    if [[ $package != libfreefem++* ]] || apt-cache show "$package" >/dev/null 2>&1; then wanted+=("$package"); fi
  done
  apt install -y --no-install-recommends "${wanted[@]}"
}
if [ ${#missing[@]} -gt 0 ]; then install "${missing[@]}" || stop "cannot install without apt-get and root or sudo; as root run: apt-get install ${missing[*]}"; fi
[ -d /usr/include/eigen3 ] || install libeigen3-dev || stop "no Eigen: apt-get install libeigen3-dev"

# What the kernels are compiled with (orchestrate/ffimpact/freefem/kernels.py).
installed() { dpkg -s "$1" >/dev/null 2>&1; }
tools=()
for package in g++ libsuitesparse-dev; do installed $package || tools+=("$package"); done
if installed freefem++ && ! installed libfreefem++-dev; then tools+=(libfreefem++-dev); fi   # others bring their headers with them
if [ ${#tools[@]} -gt 0 ]; then install "${tools[@]}" || stop "cannot install ${tools[*]}, which the compiled kernels need"; fi

# Debian's FreeFem++ looks for its plugins in a folder that does not exist.
if ! probe; then
  plugins=/usr/lib/freefem++
  FF_LOADPATH=$plugins probe || stop "FreeFem++ does not run edp/program/version.edp: ${answer//$'\n'/ | }"
  line="loadpath += \"$plugins\""
  file=${HOME:-}/.freefem++.pref
  if [ -n "${HOME:-}" ] && { grep -qsF "$line" "$file" || echo "$line" >> "$file"; } 2>/dev/null && probe; then
    say "FreeFem++ did not find its plugins: added  $line  to ~/.freefem++.pref"
  else   # Python tells it itself
    say "FreeFem++ does not find its plugins, and there is no HOME to say so in ('${HOME:-}'): for runs without Python set FF_LOADPATH=$plugins"
  fi
fi

[ -x .venv/bin/python ] || "$(find_python)" -m venv .venv || stop "no python >= 3.11 with venv found; apt-get install python3 python3-venv"
.venv/bin/python -m pip install -q --disable-pip-version-check -r requirements.lock
.venv/bin/python -m pip install -q --disable-pip-version-check --no-deps -e .   # import ffimpact, and the command
.venv/bin/python -c 'import gmsh, matplotlib.pyplot'   # they load, and matplotlib's font list is made now, not in the first run
.venv/bin/python -m compileall -q orchestrate           # now, not in the first run, or in every one where nothing may be written
.venv/bin/python -c 'from ffimpact.freefem import freefem; freefem.find()'   # compiles the clock and the kernels
say "ready"
