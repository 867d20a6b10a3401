python benchmarks/peers/board.py --keep --codes exact --problems 'PS-*'
