"""FreeFEM: its process, the compiled kernels and the descriptions that its scripts give."""
