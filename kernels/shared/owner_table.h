// Rows of the owner table, and what they lead to, one per lane. A foreign image may name rows that do not exist.
#ifndef UNDERSTORY_OWNER_TABLE_H
#define UNDERSTORY_OWNER_TABLE_H

#include "kernels/shared/real.h"

/// Row within the table; rows beyond it are the background's.
SHARED bits owner_row(bits owner, uint owners) { return PICK(owner < (bits)(owners), owner, (bits)(0u)); }

/// Whether `crown`, -1 for none, is a row of the crown table.
SHARED truth has_crown(whole crown, uint crowns) { return (crown >= 0) & (crown < (whole)((int)crowns)); }

/// Row of the crown table; the first for owners without a crown.
SHARED bits crown_row(whole crown, uint crowns) { return PICK(has_crown(crown, crowns), TO_BITS(crown), (bits)(0u)); }

#endif
