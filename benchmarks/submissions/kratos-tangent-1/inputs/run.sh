python benchmarks/peers/board.py --keep --codes kratos-tangent-1 --problems 'PS-*'
