;;; test.el --- Emacs shows findings and hover, and applies a quick-fix  -*- lexical-binding: t; -*-

;; Run by tests/clients/run: emacs --batch -q -l editors/emacs/plclint.el -l test.el FILE

(require 'eglot)
(require 'flymake)
(require 'json)

(defconst test-patience 60)

(defun test-wait (what is-so)
  "Wait until IS-SO, else say WHAT did not come."
  (let ((end (+ (float-time) test-patience)))
    (while (not (funcall is-so))
      (when (> (float-time) end)
        (error "Waited in vain: %s; shown: %S" what (test-shown)))
      (accept-process-output nil 0.02))))

(defun test-shown ()
  "The lines that Flymake shows findings at, in order."
  (sort (mapcar (lambda (it) (line-number-at-pos (flymake-diagnostic-beg it) t)) (flymake-diagnostics)) #'<))

(defun test-checked ()
  "The lines that the command line finds something at, in order."
  (let* ((output (make-temp-file "plclint" nil ".json"))
         (path buffer-file-name)
         (json-array-type 'list))
    (call-process plclint-program nil nil nil "check" (file-name-directory path) "--format" "json" "-o" output)
    (sort (delq nil (mapcar (lambda (it)
                              (and (equal (alist-get 'path it) path)
                                   (not (alist-get 'suppressed it))
                                   (alist-get 'line (alist-get 'start it))))
                            (alist-get 'findings (json-read-file output))))
          #'<)))

(defun test-find (text)
  (goto-char (point-min))
  (search-forward text)
  (goto-char (match-beginning 0)))

(let* ((plclint-program (getenv "PLCLINT"))
       (file (expand-file-name (pop command-line-args-left)))
       (default-directory (file-name-directory file))
       (eglot-sync-connect 60)
       (eglot-confirm-server-initiated-edits nil))
  (setq-default flymake-no-changes-timeout 0.1
                eglot-send-changes-idle-time 0.1)
  (find-file file)
  (unless (derived-mode-p 'plclint-mode)
    (error "The mode is %s" major-mode))
  ;; A batch run has no command loop, whose end `eglot-ensure' waits for.
  (run-hooks 'post-command-hook)
  (unless (eglot-managed-p)
    (eglot 'plclint-mode (eglot--current-project) 'eglot-lsp-server (plclint--command) nil))
  (flymake-mode 1)
  (let ((expected (test-checked)))
    (test-wait "findings" (lambda () (flymake-start) (equal (test-shown) expected)))

    (test-find "%MB100:8")
    (let* ((server (eglot--current-server-or-lose))
           (hover (jsonrpc-request server :textDocument/hover (eglot--TextDocumentPositionParams))))
      (unless (string-match-p "%MB100:8" (plist-get (plist-get hover :contents) :value))
        (error "Hover tells %S" hover)))

    (test-find "%MW5:=0 THEN")
    (search-forward ":")
    (backward-char)
    (cl-letf (((symbol-function 'completing-read)
               (lambda (_prompt options &rest _)
                 (or (seq-find (lambda (it) (string-match-p "Write `=`" it)) (mapcar #'car options))
                     (error "No quick-fix among %S" (mapcar #'car options))))))
      ;; As if a key had asked: otherwise a menu of the mouse opens.
      (let ((last-nonmenu-event ?a))
        (eglot-code-actions (point) (1+ (point)) "quickfix" t)))
    (test-wait "quick-fix" (lambda () (save-excursion (goto-char (point-min)) (search-forward "IF %MW5=0 THEN" nil t))))
    (save-buffer)
    (let ((fixed (test-checked)))
      (unless (< (length fixed) (length expected))
        (error "The fix mends nothing"))
      (test-wait "findings of the fixed text" (lambda () (flymake-start) (equal (test-shown) fixed)))))
  (let ((server (eglot--current-server-or-lose)))
    (eglot-shutdown server nil 20)
    (when (jsonrpc-running-p server)
      (error "The server runs on")))
  (princ (format "Emacs %s, eglot: all is well\n" emacs-version))
  (kill-emacs 0))
;;; test.el ends here
