"""FreeFEM: its process, the compiled kernels and the files of arrays that its scripts take."""
