"""Many runs of one kind of question: what they cost, how they converge, what holds and what fails."""
