//% # What packs the parameters of a module's models into a GBuffer and unpacks them, for GLSL and
//% # ESSL.  Functions are written by emit/listing.cpp, layouts by emit/layout.cpp.
// ${banner}
//% for remark in remarks
// ${remark.text}
//% end
//
// How parameters are packed, and the functions that do it. A pack function takes values and returns
// what a UNORM channel is to store; an unpack function takes what the channel reads. Values in
// between are rounded to the nearest code by both.
//% for layout in layouts
//
//% for line in layout.lines
// ${line.text}
//% end
//% end
#ifndef ${guard}
#define ${guard}

//% for precision in precisions
precision highp float;

//% end
//% for helper in helpers
${helper.text}

//% end
//% for function in functions
//% for line in function.comment
// ${line.text}
//% end
${function.signature}
{
//% for statement in function.statements
    ${statement.text}
//% end
}

//% end
#endif  // ${guard}
