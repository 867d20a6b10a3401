python benchmarks/peers/board.py --keep --codes kratos --problems 'PS-*'
