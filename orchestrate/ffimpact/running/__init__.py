"""Runs a scene in FreeFem++, together with the further runs that its error estimate needs."""
