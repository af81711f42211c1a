"""The input of a user: parameters, tables of a scene, their rules, and the dimension."""
