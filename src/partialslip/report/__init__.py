"""What people see of a run: the terminal table, the files, the traction plot and the page; and the stick-zone map."""

from partialslip.report.files import write_files as write_files
from partialslip.report.files import write_run as write_run
from partialslip.report.files import write_texts as write_texts
from partialslip.report.live import live_page as live_page
from partialslip.report.map import place as place
from partialslip.report.map import write_map as write_map
from partialslip.report.record import record as record
from partialslip.report.stickmap import stick_map as stick_map
from partialslip.report.table import print_run as print_run
from partialslip.report.table import print_table as print_table
