"""What people see of a run: the terminal table, the files, the traction plot and the page."""

from partialslip.report.files import write_run as write_run
from partialslip.report.record import record as record
from partialslip.report.table import print_run as print_run
