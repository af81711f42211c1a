"""Measurements of the program itself, commands of `python -m ffimpact` in the source folder: what it costs, how its errors fall, what it promises and
what it does with hard scenes; other programs beside it (peers)."""
