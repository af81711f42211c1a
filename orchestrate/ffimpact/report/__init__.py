"""Output of finished runs: printed reports, figures, films and the comparison with the paper."""
