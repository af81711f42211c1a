"""The page that compares the statements of the paper with our results."""
