"""Verification: scripts print numbers, which are compared with closed-form solutions and other
programs."""
