//! Requests: which are answered, and by what.

use super::document::Document;
use super::navigation::{self, Found};
use super::refusal::Refusal;
use super::workspace::{Documents, Workspace};
use super::{
    actions, completion, description, folding, formatting, hints, lenses, links, outline, rename,
    signature, tokens, workspace_symbols,
};
use lsp_types::request::{
    CodeActionRequest, CodeLensRequest, Completion, DocumentHighlightRequest, DocumentLinkRequest,
    DocumentSymbolRequest, FoldingRangeRequest, Formatting, GotoDefinition, HoverRequest,
    InlayHintRequest, PrepareRenameRequest, References, Rename, Request, SemanticTokensFullRequest,
    SignatureHelpRequest, WorkspaceSymbolRequest,
};
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeActionParams, CodeActionProviderCapability,
    CodeActionResponse, CodeLens, CodeLensOptions, CodeLensParams, CompletionOptions,
    CompletionParams, CompletionResponse, DocumentFormattingParams, DocumentHighlight,
    DocumentHighlightParams, DocumentLink, DocumentLinkOptions, DocumentLinkParams,
    DocumentSymbolParams, DocumentSymbolResponse, FoldingRange, FoldingRangeParams,
    FoldingRangeProviderCapability, GotoDefinitionParams, GotoDefinitionResponse, Hover,
    HoverParams, HoverProviderCapability, InlayHint, InlayHintParams, Location, OneOf,
    PositionEncodingKind, PrepareRenameResponse, ReferenceParams, RenameOptions, RenameParams,
    SemanticTokens, SemanticTokensFullOptions, SemanticTokensOptions, SemanticTokensParams,
    SemanticTokensResult, ServerCapabilities, SignatureHelp, SignatureHelpOptions,
    SignatureHelpParams, TextDocumentPositionParams, TextDocumentSyncCapability,
    TextDocumentSyncKind, TextDocumentSyncOptions, TextEdit, Uri, WorkDoneProgressOptions,
    WorkspaceEdit, WorkspaceSymbolParams, WorkspaceSymbolResponse,
};
use serde_json::Value;
use std::sync::Arc;

/// What the server can do.
pub fn capabilities() -> ServerCapabilities {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::INCREMENTAL),
        ..TextDocumentSyncOptions::default()
    };
    let colours = SemanticTokensOptions {
        legend: tokens::legend(),
        full: Some(SemanticTokensFullOptions::Bool(true)),
        ..SemanticTokensOptions::default()
    };
    let actions = CodeActionOptions {
        code_action_kinds: Some(vec![CodeActionKind::QUICKFIX]),
        ..CodeActionOptions::default()
    };
    let rename = RenameOptions {
        prepare_provider: Some(true),
        work_done_progress_options: WorkDoneProgressOptions::default(),
    };
    ServerCapabilities {
        text_document_sync: Some(TextDocumentSyncCapability::Options(sync)),
        document_symbol_provider: Some(OneOf::Left(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(vec![".".to_owned(), "(".to_owned()]),
            ..CompletionOptions::default()
        }),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        document_highlight_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(rename)),
        semantic_tokens_provider: Some(colours.into()),
        code_action_provider: Some(CodeActionProviderCapability::Options(actions)),
        inlay_hint_provider: Some(OneOf::Left(true)),
        workspace_symbol_provider: Some(OneOf::Left(true)),
        folding_range_provider: Some(FoldingRangeProviderCapability::Simple(true)),
        code_lens_provider: Some(CodeLensOptions { resolve_provider: Some(false) }),
        document_link_provider: Some(DocumentLinkOptions {
            resolve_provider: Some(false),
            work_done_progress_options: WorkDoneProgressOptions::default(),
        }),
        signature_help_provider: Some(SignatureHelpOptions {
            trigger_characters: Some(vec!["(".to_owned(), ",".to_owned()]),
            ..SignatureHelpOptions::default()
        }),
        // What every client knows.
        position_encoding: Some(PositionEncodingKind::UTF16),
        ..ServerCapabilities::default()
    }
}

/// Answers a request.
///
/// # Errors
/// It is not known, its parameters are not those of its method, or it cannot be served.
pub fn answer(
    workspace: &mut Workspace,
    documents: &Documents,
    method: &str,
    params: Value,
) -> Result<Value, Refusal> {
    let mut context = RequestContext { workspace, all: documents };
    match method {
        DocumentSymbolRequest::METHOD => {
            context.with::<DocumentSymbolRequest>(params, RequestContext::outline)
        }
        Formatting::METHOD => context.with::<Formatting>(params, RequestContext::formatting),
        HoverRequest::METHOD => context.with::<HoverRequest>(params, RequestContext::hover),
        Completion::METHOD => context.with::<Completion>(params, RequestContext::completion),
        GotoDefinition::METHOD => {
            context.with::<GotoDefinition>(params, RequestContext::definition)
        }
        References::METHOD => context.with::<References>(params, RequestContext::references),
        DocumentHighlightRequest::METHOD => {
            context.with::<DocumentHighlightRequest>(params, RequestContext::highlights)
        }
        PrepareRenameRequest::METHOD => {
            context.with::<PrepareRenameRequest>(params, RequestContext::prepare_rename)
        }
        Rename::METHOD => context.with::<Rename>(params, RequestContext::rename),
        SemanticTokensFullRequest::METHOD => {
            context.with::<SemanticTokensFullRequest>(params, RequestContext::tokens)
        }
        CodeActionRequest::METHOD => {
            context.with::<CodeActionRequest>(params, RequestContext::actions)
        }
        InlayHintRequest::METHOD => context.with::<InlayHintRequest>(params, RequestContext::hints),
        WorkspaceSymbolRequest::METHOD => {
            context.with::<WorkspaceSymbolRequest>(params, RequestContext::symbols)
        }
        FoldingRangeRequest::METHOD => {
            context.with::<FoldingRangeRequest>(params, RequestContext::folding)
        }
        CodeLensRequest::METHOD => context.with::<CodeLensRequest>(params, RequestContext::lenses),
        DocumentLinkRequest::METHOD => {
            context.with::<DocumentLinkRequest>(params, RequestContext::links)
        }
        SignatureHelpRequest::METHOD => {
            context.with::<SignatureHelpRequest>(params, RequestContext::signature)
        }
        _ => Err(Refusal::unknown(method)),
    }
}

/// What a request works with.
struct RequestContext<'a> {
    workspace: &'a mut Workspace,
    all: &'a Documents,
}

impl RequestContext<'_> {
    /// Decodes the parameters of a request, and encodes its result.
    fn with<R: Request>(
        &mut self,
        params: Value,
        work: impl FnOnce(&mut Self, R::Params) -> Result<R::Result, Refusal>,
    ) -> Result<Value, Refusal> {
        let params = serde_json::from_value(params).map_err(|error| Refusal::malformed(&error))?;
        let result = work(self, params)?;
        serde_json::to_value(result).map_err(|error| Refusal::failed(error.to_string()))
    }

    fn document(&self, uri: &Uri) -> Result<Arc<Document>, Refusal> {
        let document = self.all.get(uri.as_str()).cloned();
        document.ok_or_else(|| Refusal::failed(format!("`{}` is not open", uri.as_str())))
    }

    fn found(&mut self, at: &TextDocumentPositionParams) -> Result<Option<Found>, Refusal> {
        let document = self.document(&at.text_document.uri)?;
        Ok(navigation::at(self.workspace, &document, self.all, at.position))
    }

    fn outline(
        &mut self,
        params: DocumentSymbolParams,
    ) -> Result<Option<DocumentSymbolResponse>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        let parsed = self.workspace.open(&document, self.all);
        let symbols = outline::symbols(&parsed);
        Ok(Some(match self.workspace.client.nested_outline {
            true => DocumentSymbolResponse::Nested(symbols),
            false => DocumentSymbolResponse::Flat(outline::flat(&document, symbols)),
        }))
    }

    fn formatting(
        &mut self,
        params: DocumentFormattingParams,
    ) -> Result<Option<Vec<TextEdit>>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        formatting::edits(&document).map(Some)
    }

    fn hover(&mut self, params: HoverParams) -> Result<Option<Hover>, Refusal> {
        let Some(found) = self.found(&params.text_document_position_params)? else {
            return Ok(None);
        };
        let library = self.workspace.session.library();
        let text = description::markdown(library, found.one.entity).or_else(|| assigned(&found));
        let range = Some(found.parsed.document.range(found.one.range.clone()));
        let client = &self.workspace.client;
        Ok(text.map(|text| Hover { contents: client.hover(text), range }))
    }

    fn completion(
        &mut self,
        params: CompletionParams,
    ) -> Result<Option<CompletionResponse>, Refusal> {
        let at = params.text_document_position;
        let document = self.document(&at.text_document.uri)?;
        let items = completion::items(self.workspace, &document, self.all, at.position);
        Ok(Some(CompletionResponse::Array(items)))
    }

    fn definition(
        &mut self,
        params: GotoDefinitionParams,
    ) -> Result<Option<GotoDefinitionResponse>, Refusal> {
        let found = self.found(&params.text_document_position_params)?;
        let place = found.and_then(|found| navigation::definition(self.workspace, &found));
        Ok(place.map(GotoDefinitionResponse::Scalar))
    }

    fn references(&mut self, params: ReferenceParams) -> Result<Option<Vec<Location>>, Refusal> {
        let Some(found) = self.found(&params.text_document_position)? else { return Ok(None) };
        let with_declaration = params.context.include_declaration;
        let places = navigation::references(self.workspace, &found, self.all);
        let locations = places.iter().flat_map(|places| {
            let requested =
                places.names.iter().filter(move |one| with_declaration || !one.is_declaration);
            requested.map(|one| Location {
                uri: places.document.uri.clone(),
                range: places.document.range(one.range.clone()),
            })
        });
        Ok(Some(locations.collect()))
    }

    fn highlights(
        &mut self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>, Refusal> {
        let found = self.found(&params.text_document_position_params)?;
        Ok(found.map(|found| navigation::highlights(&found)))
    }

    fn prepare_rename(
        &mut self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>, Refusal> {
        let Some(found) = self.found(&params)? else { return Ok(None) };
        rename::check(self.workspace, &found, self.all)?;
        let range = found.parsed.document.range(found.one.range.clone());
        Ok(Some(PrepareRenameResponse::Range(range)))
    }

    fn rename(&mut self, params: RenameParams) -> Result<Option<WorkspaceEdit>, Refusal> {
        let found = self.found(&params.text_document_position)?;
        let found = found.ok_or_else(|| Refusal::failed("there is no name here"))?;
        rename::edits(self.workspace, &found, self.all, &params.new_name).map(Some)
    }

    fn tokens(
        &mut self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        let parsed = self.workspace.open(&document, self.all);
        let names = self.workspace.names(&parsed);
        let data = tokens::tokens(self.workspace.session.library(), &parsed, &names);
        Ok(Some(SemanticTokensResult::Tokens(SemanticTokens { result_id: None, data })))
    }

    fn actions(&mut self, params: CodeActionParams) -> Result<Option<CodeActionResponse>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        let parsed = self.workspace.open(&document, self.all);
        let client = &self.workspace.client;
        Ok(Some(actions::actions(client, &parsed, &params.context.diagnostics)))
    }

    fn symbols(
        &mut self,
        params: WorkspaceSymbolParams,
    ) -> Result<Option<WorkspaceSymbolResponse>, Refusal> {
        let found = workspace_symbols::symbols(self.workspace, self.all, &params.query);
        Ok(Some(WorkspaceSymbolResponse::Flat(found)))
    }

    fn folding(
        &mut self,
        params: FoldingRangeParams,
    ) -> Result<Option<Vec<FoldingRange>>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        Ok(Some(folding::ranges(&self.workspace.open(&document, self.all))))
    }

    fn lenses(&mut self, params: CodeLensParams) -> Result<Option<Vec<CodeLens>>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        if document.is_toml() {
            return Ok(Some(lenses::problem(&document)));
        }
        Ok(Some(lenses::models(&self.workspace.open(&document, self.all))))
    }

    fn links(&mut self, params: DocumentLinkParams) -> Result<Option<Vec<DocumentLink>>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        let parsed = self.workspace.open(&document, self.all);
        Ok(Some(links::links(self.workspace, &parsed)))
    }

    fn signature(&mut self, params: SignatureHelpParams) -> Result<Option<SignatureHelp>, Refusal> {
        let at = params.text_document_position_params;
        let document = self.document(&at.text_document.uri)?;
        Ok(signature::help(self.workspace, &document, self.all, at.position))
    }

    fn hints(&mut self, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>, Refusal> {
        let document = self.document(&params.text_document.uri)?;
        let parsed = self.workspace.open(&document, self.all);
        let names = self.workspace.names(&parsed);
        let within = document.lines.bytes(&document.text, params.range);
        Ok(Some(hints::hints(self.workspace.session.library(), &parsed, &names, within)))
    }
}

/// The first statement of a script that assigns a variable.
fn assigned(found: &Found) -> Option<String> {
    let first = found.names.iter().find(|one| one.entity == found.one.entity)?;
    let document = &found.parsed.document;
    let line = document.lines.content(&document.text, document.lines.line_of(first.range.start));
    Some(format!("```modelica\n{}\n```", document.text[line].trim()))
}
