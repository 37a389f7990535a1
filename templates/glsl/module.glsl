//% # The include file of one module for GLSL and ESSL.  Functions are written by emit/listing.cpp,
//% # models by emit/shading_language.cpp.
// ${banner}
//% for remark in remarks
// ${remark.text}
//% end
//% for line in doc
// ${line.text}
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
//% for model in models
//% for structure in model.parameters
struct ${structure.type}
{
//% for member in structure.members
//% for line in member.comment
    // ${line.text}
//% end
    ${member.type} ${member.name};
//% end
};

${structure.type} ${structure.defaults}()
{
    ${structure.type} parameters;
//% for member in structure.members
    parameters.${member.name} = ${member.value};
//% end
    return parameters;
}

//% end
//% for structure in model.surfaces
struct ${structure.type}
{
//% for member in structure.members
//% for line in member.comment
    // ${line.text}
//% end
    ${member.type} ${member.name};
//% end
};

//% end
// The outputs of ${model.name}.
// Where a light is meant, the cosine of its angle is in them already.
struct ${model.result}
{
//% for output in model.outputs
    ${output.type} ${output.name};
//% end
};

//% for line in model.comment
// ${line.text}
//% end
// All vectors have length 1 and point away from the surface.
${model.signature}
{
//% for statement in model.statements
    ${statement.text}
//% end
}

//% end
#endif  // ${guard}
