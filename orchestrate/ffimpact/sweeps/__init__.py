"""One scene over a range of parameters: sweep files, beside them in *.toml, and their figures."""
