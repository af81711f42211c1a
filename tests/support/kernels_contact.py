"""Helpers that the modules test_kernels_contact.py share."""



STEADY, JUMPING = dict(friction_static=0.6, friction_dynamic=0.6), dict(friction_static=0.7, friction_dynamic=0.5)
