"""The output of a run: its folder, its results and their error estimates."""
