"""One run of a script, and the others that its stated error needs."""
