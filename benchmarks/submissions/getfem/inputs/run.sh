python benchmarks/peers/board.py --keep --codes getfem --problems 'PS-*'
