"""Robustness of controllers: the largest disturbances that 95 % of randomly drawn boats survive."""
