"""Tests by speed: unit/ needs no FreeFEM, run/ runs it, hostile/ runs with `make robustness` only;
support/ has shared helpers."""
