"""FreeFEM: its process, the compiled kernels, what its scripts say of themselves."""
