python benchmarks/peers/board.py --keep --codes fem-P2 --problems 'PS-*'
