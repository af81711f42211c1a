"""Shared by the tests of kernels_contact."""



STEADY, JUMPING = dict(friction_static=0.6, friction_dynamic=0.6), dict(friction_static=0.7, friction_dynamic=0.5)
