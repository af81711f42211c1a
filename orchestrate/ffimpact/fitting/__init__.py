"""Materials from measurements: experiments, their predictions by runs, and the fit."""
