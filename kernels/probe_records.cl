// Reports how this device lays out the records that it shares with the host: per field its offset and size, per record its size.
#pragma OPENCL FP_CONTRACT OFF
#include "kernels/shared/record_fields.h"

#define REPORT_FIELD(record, name)                               \
  {                                                              \
    record value;                                                \
    out[n++] = (uint)((private char*)&value.name - (private char*)&value); \
    out[n++] = (uint)sizeof(value.name);                         \
  }
#define REPORT_RECORD(record) out[n++] = (uint)sizeof(record);

/// One work-item; `out` has room for every number of the list.
kernel void probe_records(global uint* out) {
  if (get_global_id(0) != 0) return;
  uint n = 0;
  UNDERSTORY_RECORD_FIELDS(REPORT_RECORD, REPORT_FIELD)
}
