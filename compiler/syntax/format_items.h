// The items that are blocks of lines, to canonical text; inside `syntax` only. Each writes up to
// the closing brace; what stands around an item is format.cpp's.
#pragma once

#include "syntax/format_lines.h"
#include "syntax/tree.h"

namespace lobe::syntax {

void write_gbuffer(LineWriter& writer, const GbufferItem& gbuffer);
void write_code(LineWriter& writer, const CodeItem& code);
void write_packing(LineWriter& writer, const PackingItem& packing);
void write_engine(LineWriter& writer, const EngineItem& engine);

}  // namespace lobe::syntax
