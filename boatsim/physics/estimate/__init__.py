"""Rules that estimate the coefficients of a boat from its main particulars."""
