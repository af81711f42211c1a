"""What a user may say: parameters, tables of TOML, the words of a dimension."""
