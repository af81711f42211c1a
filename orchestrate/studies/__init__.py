"""Many runs for one question of the paper or of theory, with its own table and figure."""
