"""Tests by speed: unit/ needs no FreeFEM, run/ runs it, hostile/ is what make test leaves out; what they share is in support/."""
