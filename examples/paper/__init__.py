"""The page of the paper's statements, each beside our results."""
