r"""The linear model in other tools' forms.

Each holds the equations of motion with their outputs,

.. math:: M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f

.. math:: y = Y_a \ddot q + Y_v \dot q + Y_d q + Y_w w + Y_{dw} \dot w + Y_f f ,

as symbols, as functions of the parameters or as numbers, with names and SI units.
"""
