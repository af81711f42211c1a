"""Exact cases: scripts that print their numbers, closed forms that these must meet, and other programs (peers) on the same problem."""
