"""What a run leaves: its folder, its results, the errors that they state."""
