"""Everything written and shown, from the plain data of porolub.solve.report; rank 0 only."""
