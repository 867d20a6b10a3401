python benchmarks/peers/board.py --keep --codes getfem-graded --problems 'PS-*'
