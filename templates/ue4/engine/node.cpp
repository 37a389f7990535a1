UMaterialExpression${Node}::UMaterialExpression${Node}(const FObjectInitializer& ObjectInitializer)
	: Super(ObjectInitializer)
{
#if WITH_EDITORONLY_DATA
	MenuCategories.Add(LOCTEXT("${Node}Category", ${display}));
#endif

	Outputs.Reset();
}

#if WITH_EDITOR
int32 UMaterialExpression${Node}::Compile(class FMaterialCompiler* Compiler, int32 OutputIndex)
{
	int32 Code = INDEX_NONE;
	switch (OutputIndex)
	{
//% for input in inputs
	case ${input.index}:
//% for number in input.number
		Code = ${input.name}.IsConnected() ? Compiler->ForceCast(${input.name}.Compile(Compiler), MCT_Float1) : Compiler->Constant(${number.value});
//% end
//% for color in input.color
		Code = ${input.name}.IsConnected() ? Compiler->ForceCast(${input.name}.Compile(Compiler), MCT_Float3) : Compiler->Constant3(${color.r}, ${color.g}, ${color.b});
//% end
		break;
//% end
	default:
		break;
	}
	return Compiler->CustomOutput(this, OutputIndex, Code);
}

void UMaterialExpression${Node}::GetCaption(TArray<FString>& OutCaptions) const
{
	OutCaptions.Add(TEXT(${caption}));
}
#endif

int32 UMaterialExpression${Node}::GetNumOutputs() const
{
	return ${input_count};
}

FString UMaterialExpression${Node}::GetFunctionName() const
{
	return TEXT("${Node}");
}

FString UMaterialExpression${Node}::GetDisplayName() const
{
	return TEXT(${caption});
}
