python benchmarks/peers/board.py --keep --codes fem-1e-4 --problems 'PS-*'
